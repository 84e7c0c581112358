// Completes a scene for rendering: normals where meshes lack them, tangents under normal maps, and
// a key light with a sky where nothing lights the scene. Surfaces that glow count as light only if
// their power would light the box of the scene visibly.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel/parallel_for.h"
#include "scenes/complete_part.h"
#include "scenes/geometry/normals.h"
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

// Light on a white surface that it sends back as code 8 of 255 in sRGB.
constexpr double kDarkest = 0.0025 * std::numbers::pi;

bool shines(const glm::vec3& radiance) {
  return glm::any(glm::greaterThan(radiance, glm::vec3(0)));
}

bool lights_others(const Material& material) {
  if (material.unlit || !shines(material.emission)) return false;
  return material.emission_texture == kNone ||
         glm::any(glm::greaterThan(material.emission, glm::vec3(1)));
}

double area(const Mesh& mesh, const glm::mat4x3& transform) {
  const glm::dmat3 linear{glm::dvec3(transform[0]), glm::dvec3(transform[1]),
                          glm::dvec3(transform[2])};
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]);
    sum += 0.5 * glm::length(glm::cross(linear * (glm::dvec3(mesh.positions[t.y]) - a),
                                        linear * (glm::dvec3(mesh.positions[t.z]) - a)));
  }
  return sum;
}

float cosine_of(float degrees) { return std::cos(degrees * std::numbers::pi_v<float> / 180.0F); }

void add_tangents(const Scene& scene, Mesh& mesh) {
  const std::uint32_t texture = scene.materials[mesh.material].normal_texture;
  if (texture == kNone || !mesh.tangents.empty()) return;
  const int set = texture < scene.textures.size() ? scene.textures[texture].set : 0;
  if (!mesh.uvs_of(set).empty()) internal::compute_tangents(mesh, set);
}

}  // namespace

bool is_lit_by_emission(const Scene& scene) {
  double power = 0.0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.material >= scene.materials.size()) continue;
    const Material& material = scene.materials[mesh.material];
    if (!lights_others(material)) continue;
    const glm::dvec3 radiance(material.emission);
    const double mean = (radiance.x + radiance.y + radiance.z) / 3.0;
    power += 2.0 * std::numbers::pi * mean * area(mesh, instance.transform);  // on both sides
  }
  if (!(power > 0.0)) return false;
  const glm::dvec3 size(bounds(scene).size());
  return power >= kDarkest * 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

bool has_light(const Scene& scene) {
  const Environment& sky = scene.environment;
  return !scene.lights.empty() || sky.texture != kNone || shines(sky.zenith) ||
         shines(sky.horizon) || shines(sky.ground) || is_lit_by_emission(scene);
}

void add_default_light(Scene& scene, const Camera& camera, float strength) {
  const View view = make_view(camera, 1, 1);
  Light key;
  key.kind = Light::Kind::directional;
  key.colour = glm::vec3(1.0F, 0.985F, 0.95F) * (kKey * strength);
  key.direction = glm::normalize(view.forward - view.right * kKeyRight - view.up * kKeyUp);
  scene.lights.push_back(key);
  scene.environment = {};
  scene.environment.up = scene.z_up ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  scene.environment.zenith = kZenith * strength;
  scene.environment.horizon = kHorizon * strength;
  scene.environment.ground = kGround * strength;
}

void complete_part(Mesh& part, std::uint32_t first, std::uint32_t count, float crease_degrees) {
  internal::compute_normals(part, cosine_of(crease_degrees));
  part.triangles.erase(part.triangles.begin(), part.triangles.begin() + first);
  part.triangles.resize(count);
}

void complete_surfaces(Scene& scene, float crease_degrees) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  const float crease_cosine = cosine_of(crease_degrees);
  parallel::parallel_for(0, scene.meshes.size(), 1, [&](std::size_t i) {
    Mesh& mesh = scene.meshes[i];
    if (!mesh.has_triangles()) return;
    if (mesh.normals.empty()) internal::compute_normals(mesh, crease_cosine);
    add_tangents(scene, mesh);
  });
}

void complete(Scene& scene, const Camera& camera, float crease_degrees) {
  complete_surfaces(scene, crease_degrees);
  if (!has_light(scene)) add_default_light(scene, camera);
}

}  // namespace delray::scenes
