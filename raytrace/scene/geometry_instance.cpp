// Makes the geometry instances of a scene: moves meshes with one instance to the world, and finds
// normal matrices, orientations and opaque triangles.
#include "raytrace/scene/geometry_instance.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"
#include "raytrace/scene/opaque_triangles.h"
#include "scenes/pose.h"

namespace delray::raytrace {
namespace {

constexpr std::size_t kVerticesPerBlock = 1 << 14;  // some tens of microseconds

// Embree ignores vertices beyond this, where squares would overflow.
constexpr float kLargest = 1.0e18F;

bool usable(const glm::vec3& p) {
  return std::abs(p.x) < kLargest && std::abs(p.y) < kLargest && std::abs(p.z) < kLargest;
}

void move_to_world(GeometryInstance& instance) {
  const std::vector<glm::vec3>& from = instance.mesh->positions;
  instance.moved.resize(from.size() + 1);
  parallel::parallel_for(0, from.size(), kVerticesPerBlock, [&](std::size_t i) {
    instance.moved[i] = instance.to_world * glm::vec4(from[i], 1.0F);
  });
  instance.positions = instance.moved.data();
}

void look_at_material(GeometryInstance& instance, const shading::Shader& shader) {
  const scenes::Material& material = shader.materials[instance.material];
  const bool triangles = instance.mesh->has_triangles();
  instance.layered = triangles && material.alpha != scenes::Material::Alpha::opaque;
  instance.see_through = instance.layered || (triangles && material.transmission > 0.0F);
  instance.texture_sets = shading::texture_sets(shader, material);
}

// The largest coordinate of a mesh.
float reach(const scenes::Mesh& mesh) {
  float result = 0.0F;
  for (const glm::vec3& p : mesh.positions) result = std::max(result, largest_magnitude(p));
  return result;
}

void look_at_transform(GeometryInstance& instance, float mesh_reach) {
  const glm::mat3 linear(instance.to_world);
  instance.identity = instance.to_world == glm::mat4x3(1.0F);
  if (instance.identity) return;
  // The matrix of cofactors is the inverse transpose times the determinant, and exists always. Its
  // size does not matter: it is that of a transform of about size 1, lest numbers overflow.
  int exponent = 0;
  std::frexp(std::max(std::max(largest_magnitude(linear[0]), largest_magnitude(linear[1])),
                      largest_magnitude(linear[2])),
             &exponent);
  const glm::mat3 m = linear * std::ldexp(1.0F, -exponent);
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  instance.orientation = glm::dot(m[0], cofactors[0]) < 0.0F ? -1.0F : 1.0F;
  instance.normal_to_world = cofactors * instance.orientation;
  const float stretch =
      std::max(std::max(glm::length(linear[0]), glm::length(linear[1])), glm::length(linear[2]));
  instance.transform_scale = stretch * mesh_reach + largest_magnitude(instance.to_world[3]);
}

}  // namespace

std::vector<GeometryInstance> make_instances(const scenes::Scene& scene,
                                             const shading::Shader& shader, bool share_meshes) {
  std::vector<std::uint32_t> uses(scene.meshes.size(), 0);
  for (const scenes::Instance& placed : scene.instances) {
    if (placed.mesh < uses.size()) ++uses[placed.mesh];
  }
  const std::vector<scenes::MeshMotion> motions = scenes::mesh_motions(scene);
  std::vector<float> reaches(scene.meshes.size());
  parallel::parallel_for(0, reaches.size(), 1,
                         [&](std::size_t i) { reaches[i] = reach(scene.meshes[i]); });
  // Of meshes, where they can be seen through.
  std::vector<std::shared_ptr<const std::vector<std::uint64_t>>> opaque(scene.meshes.size());
  const std::vector<LeastAlpha> alphas = least_alphas(shader);
  parallel::parallel_for(0, opaque.size(), 1, [&](std::size_t i) {
    const scenes::Mesh& mesh = scene.meshes[i];
    if (uses[i] == 0) return;
    auto bits = opaque_triangles(mesh, shading::material(shader, mesh.material), alphas);
    if (!bits.empty()) {
      opaque[i] = std::make_shared<const std::vector<std::uint64_t>>(std::move(bits));
    }
  });
  std::vector<GeometryInstance> instances(scene.instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const scenes::Instance& placed = scene.instances[i];
    if (placed.mesh >= scene.meshes.size()) continue;
    GeometryInstance& instance = instances[i];
    instance.mesh = &scene.meshes[placed.mesh];
    instance.mesh_number = placed.mesh;
    instance.positions = instance.mesh->positions.data();
    instance.to_world = placed.transform;
    instance.material =
        instance.mesh->material < shader.materials.size() ? instance.mesh->material : 0;
    look_at_material(instance, shader);
    instance.opaque = opaque[placed.mesh];
    look_at_transform(instance, reaches[placed.mesh]);
    const scenes::MeshMotion motion = motions[placed.mesh];
    instance.deforming = motion == scenes::MeshMotion::deforming;
    instance.instanced = share_meshes && instance.mesh->has_triangles() && !instance.deforming &&
                         (uses[placed.mesh] > 1 || motion == scenes::MeshMotion::rigid);
    if (!instance.instanced && !instance.identity) move_to_world(instance);
  }
  return instances;
}

void follow(const scenes::Scene& scene, std::uint32_t number, GeometryInstance& instance) {
  instance.to_world = scene.instances[number].transform;
  instance.orientation = 1.0F;
  instance.normal_to_world = glm::mat3(1.0F);
  instance.transform_scale = 0.0F;
  look_at_transform(instance, reach(*instance.mesh));
  if (instance.instanced) return;
  instance.positions = instance.mesh->positions.data();
  if (instance.identity) {
    instance.moved.clear();
  } else {
    move_to_world(instance);
  }
}

std::uint64_t count_degenerate(std::span<const GeometryInstance> instances) {
  std::uint64_t count = 0;
  for (const GeometryInstance& instance : instances) {
    if (instance.mesh == nullptr || !instance.mesh->has_triangles()) continue;
    const auto& triangles = instance.mesh->triangles;
    count += parallel::parallel_reduce(
        0, triangles.size(), kVerticesPerBlock, std::uint64_t{0},
        [&](std::size_t first, std::size_t last) {
          std::uint64_t bad = 0;
          for (std::size_t i = first; i < last; ++i) {
            const glm::vec3& a = instance.positions[triangles[i].x];
            const glm::vec3& b = instance.positions[triangles[i].y];
            const glm::vec3& c = instance.positions[triangles[i].z];
            const glm::vec3 normal = glm::cross(b - a, c - a);
            const bool flat = normal.x == 0.0F && normal.y == 0.0F && normal.z == 0.0F;
            bad += flat || !usable(a) || !usable(b) || !usable(c) ? 1 : 0;
          }
          return bad;
        },
        [](std::uint64_t a, std::uint64_t b) { return a + b; });
  }
  return count;
}

}  // namespace delray::raytrace
