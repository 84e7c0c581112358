// Runs of the triangles of a PLY or glTF, as ranks read them: what a run gives is what the whole
// has, with vertices of its own, or FileError.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "files/error.h"
#include "scenes/files/triangle_file.h"
#include "scenes/parts/read_run.h"

namespace {

using namespace delray;
using namespace delray::scenes;
using namespace delray::scenes::internal;

void read_in_runs(const Source& source, const TriangleFile& file) {
  constexpr std::uint64_t kMost = 1 << 16, kRuns = 3;
  if (file.triangles() > kMost || file.vertices() > kMost) return;
  std::vector<glm::uvec3> all(file.triangles());
  const bool good = file.read_triangles(0, all);
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const std::uint64_t begin = all.size() * run / kRuns, end = all.size() * (run + 1) / kRuns;
    Mesh mesh = file.rest().meshes.at(0);
    if (!read_run(source, file, begin, end, mesh)) {
      if (good) std::abort();
      continue;
    }
    if (mesh.triangles.size() != end - begin) std::abort();
    for (const glm::uvec3& t : mesh.triangles)
      if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string content(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> warnings;
  const Source source{"/nowhere/fuzz", content, warnings,
                      files::MemoryBudget(std::uint64_t{1} << 30)};
  for (const auto open : {&open_ply_triangles, &open_gltf_triangles}) {
    try {
      const std::unique_ptr<TriangleFile> file = open(source);
      if (file) read_in_runs(source, *file);
    } catch (const files::FileError&) {
    }
  }
  return 0;
}
