#include "scenes/files/load_content.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "files/error.h"
#include "scenes/pose.h"

namespace {

// Poses before, between and after the keys, or a range_error that says why there is none.
void pose_everywhere(delray::scenes::Scene& scene) {
  using namespace delray;
  for (std::uint32_t a = 0; a < scene.animations.animations.size() && a < 4; ++a) {
    try {
      for (const double part : {-1.0, 0.0, 0.3, 1.0, 2.0})
        scenes::pose(scene, {a, part * scene.animations.animations[a].duration()});
    } catch (const std::range_error&) {
      scenes::pose(scene, {});
    }
  }
}

}  // namespace

// Whatever the bytes, the reader of scenes returns triangles of finite vertices or throws
// FileError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  std::vector<std::string> warnings;
  try {
    const std::string content(reinterpret_cast<const char*>(data), size);
    scenes::Scene scene = scenes::internal::load_content("/nowhere/fuzz", content, warnings);
    pose_everywhere(scene);
    for (const scenes::Instance& i : scene.instances) {
      if (i.mesh >= scene.meshes.size()) std::abort();
    }
    for (const scenes::Mesh& mesh : scene.meshes) {
      if (mesh.material >= scene.materials.size()) std::abort();
      for (const glm::vec3& p : mesh.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
      }
      for (const glm::uvec3& t : mesh.triangles) {
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) std::abort();
      }
    }
  } catch (const files::FileError&) {
  }
  return 0;
}
