// Counts and bounds over all instances, by parallel reductions over instances and vertices.
#include "scenes/scene.h"

#include "parallel/parallel_for.h"

namespace delray::scenes {
namespace {

constexpr std::size_t kVerticesPerBlock = 4096;  // some 10 microseconds of transforms

geometry::Box3 bounds_of(const Mesh& mesh, const glm::mat4x3& transform) {
  return parallel::parallel_reduce(
      0, mesh.positions.size(), kVerticesPerBlock, geometry::Box3{},
      [&](std::size_t first, std::size_t last) {
        geometry::Box3 box;
        for (std::size_t i = first; i < last; ++i) {
          box.include(transform * glm::vec4(mesh.positions[i], 1.0F));
        }
        return box;
      },
      [](geometry::Box3 a, const geometry::Box3& b) {
        a.include(b);
        return a;
      });
}

}  // namespace

std::array<std::uint32_t*, Material::kTextures> Material::textures() {
  return {&base_colour_texture,     &metallic_roughness_texture, &normal_texture,
          &emission_texture,        &transmission_texture,       &specular_texture,
          &specular_colour_texture, &clearcoat_texture,          &clearcoat_roughness_texture,
          &sheen_colour_texture,    &sheen_roughness_texture};
}

std::array<std::uint32_t, Material::kTextures> Material::textures() const {
  std::array<std::uint32_t, kTextures> result{};
  const auto all = const_cast<Material*>(this)->textures();
  for (int i = 0; i < kTextures; ++i) result[i] = *all[i];
  return result;
}

bool Material::textured() const {
  for (const std::uint32_t texture : textures()) {
    if (texture != kNone) return true;
  }
  return false;
}

std::uint64_t triangle_count(const Scene& scene) {
  return first_primitives(scene).back() - splat_count(scene);
}

std::uint64_t splat_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Instance& i : scene.instances) {
    const Mesh& mesh = scene.meshes[i.mesh];
    count += mesh.has_triangles() ? 0 : mesh.triangles.size();
  }
  return count;
}

std::uint64_t vertex_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Instance& i : scene.instances) count += scene.meshes[i.mesh].positions.size();
  return count;
}

geometry::Box3 bounds(const Scene& scene) {
  return parallel::parallel_reduce(
      0, scene.instances.size(), 1, geometry::Box3{},
      [&](std::size_t first, std::size_t last) {
        geometry::Box3 box;
        for (std::size_t i = first; i < last; ++i) {
          const Instance& instance = scene.instances[i];
          if (instance.mesh >= scene.meshes.size()) continue;
          box.include(bounds_of(scene.meshes[instance.mesh], instance.transform));
        }
        return box;
      },
      [](geometry::Box3 a, const geometry::Box3& b) {
        a.include(b);
        return a;
      });
}

std::vector<std::uint64_t> first_primitives(const Scene& scene) {
  std::vector<std::uint64_t> first{0};
  first.reserve(scene.instances.size() + 1);
  for (const Instance& i : scene.instances) {
    first.push_back(first.back() + scene.meshes[i.mesh].triangles.size());
  }
  return first;
}

}  // namespace delray::scenes
