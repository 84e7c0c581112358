#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel/parallel_for.h"
#include "scenes/internal/normals.h"
#include "scenes/scene.h"

namespace delray::scenes {
namespace {

// A diffuse surface of albedo 0.8 that faces the key light comes out at about 0.8 * (kKey / pi +
// 0.26) = 0.75; 0.26 is what it sees of the sky and the ground below.
constexpr float kKey = 0.677F * std::numbers::pi_v<float>;
constexpr glm::vec3 kZenith{0.27F, 0.31F, 0.38F};
constexpr glm::vec3 kHorizon{0.28F, 0.28F, 0.28F};
constexpr glm::vec3 kGround{0.13F, 0.12F, 0.11F};

// The key light stands over the viewer's shoulder: what faces the viewer is lit, and what turns
// away sideways or down is shaded.
constexpr float kKeyRight = -0.45F, kKeyUp = 0.65F;

bool has_light(const Scene& scene) {
  const Environment& sky = scene.environment;
  const auto shines = [](const glm::vec3& radiance) {
    return glm::any(glm::greaterThan(radiance, glm::vec3(0)));
  };
  return !scene.lights.empty() || sky.texture != kNone || shines(sky.zenith) ||
         shines(sky.horizon) || shines(sky.ground);
}

void add_light(Scene& scene, const Camera& camera) {
  const View view = make_view(camera, 1, 1);
  Light key;
  key.kind = Light::Kind::directional;
  key.colour = glm::vec3(1.0F, 0.985F, 0.95F) * kKey;
  key.direction = glm::normalize(view.forward - view.right * kKeyRight - view.up * kKeyUp);
  scene.lights.push_back(key);
  scene.environment.up = scene.z_up ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  scene.environment.zenith = kZenith;
  scene.environment.horizon = kHorizon;
  scene.environment.ground = kGround;
}

bool needs_tangents(const Scene& scene, const Mesh& mesh) {
  return scene.materials[mesh.material].normal_texture != kNone && mesh.tangents.empty() &&
         !mesh.uvs.empty();
}

}  // namespace

void complete(Scene& scene, const Camera& camera, float crease_degrees) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  const float crease_cosine = std::cos(crease_degrees * std::numbers::pi_v<float> / 180.0F);
  parallel::parallel_for(0, scene.meshes.size(), 1, [&](std::size_t i) {
    Mesh& mesh = scene.meshes[i];
    if (mesh.normals.empty()) internal::compute_normals(mesh, crease_cosine);
    if (needs_tangents(scene, mesh)) internal::compute_tangents(mesh);
  });
  if (!has_light(scene)) add_light(scene, camera);
}

}  // namespace delray::scenes
