// Quadric edge collapses by meshoptimizer (after Garland and Heckbert 1997), with the border
// locked; the error is measured afterwards (surface_error.h), since theirs is no bound. Triangles
// are then ordered along a Hilbert curve, so that pages of consecutive ones are compact.
#include "packs/build/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "packs/build/surface_error.h"
#include "packs/build/vertices.h"

namespace delray::packs::internal {
namespace {

// How far a difference of 1 between normals, colours or texture coordinates is, in edges of the
// mesh.
constexpr float kAttributeEdges = 0.25F;

template <class T>
bool is_alike(const std::vector<T>& a, std::size_t i, const std::vector<T>& b, std::size_t j) {
  return a.empty() || std::memcmp(&a[i], &b[j], sizeof(T)) == 0;
}

// Of meshes that have the same attributes.
bool is_alike(const scenes::Mesh& a, std::size_t i, const scenes::Mesh& b, std::size_t j) {
  return is_alike(a.positions, i, b.positions, j) && is_alike(a.normals, i, b.normals, j) &&
         is_alike(a.uvs, i, b.uvs, j) && is_alike(a.uvs2, i, b.uvs2, j) &&
         is_alike(a.tangents, i, b.tangents, j) && is_alike(a.colours, i, b.colours, j);
}

std::size_t hash_of(const glm::vec3& p) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ std::bit_cast<std::uint32_t>(p[k])) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

scenes::Mesh merge(std::span<const Page> pages) {
  std::size_t vertices = 0;
  for (const Page& page : pages) vertices += page.mesh.positions.size();
  scenes::Mesh mesh;
  std::vector<std::uint32_t> table(std::bit_ceil(2 * vertices + 1), scenes::kNone);
  std::vector<std::uint32_t> number;
  for (const Page& page : pages) {
    mesh.shape = page.mesh.shape;
    mesh.material = page.mesh.material;
    number.clear();
    for (std::size_t i = 0; i < page.mesh.positions.size(); ++i) {
      std::size_t slot = hash_of(page.mesh.positions[i]) & (table.size() - 1);
      while (table[slot] != scenes::kNone && !is_alike(mesh, table[slot], page.mesh, i))
        slot = (slot + 1) & (table.size() - 1);
      if (table[slot] == scenes::kNone) {
        table[slot] = static_cast<std::uint32_t>(mesh.positions.size());
        copy_vertex(page.mesh, i, mesh);
      }
      number.push_back(table[slot]);
    }
    for (const glm::uvec3& t : page.mesh.triangles)
      mesh.triangles.emplace_back(number[t.x], number[t.y], number[t.z]);
  }
  return mesh;
}

scenes::Mesh simplify(const scenes::Mesh& mesh) {
  const std::size_t corners = 3 * mesh.triangles.size();
  std::vector<std::uint32_t> kept(corners);
  const auto target =
      3 * static_cast<std::size_t>(kKept * static_cast<double>(mesh.triangles.size()));
  constexpr float kAnyError = 1e30F;
  kept.resize(meshopt_simplify(kept.data(), &mesh.triangles[0].x, corners, &mesh.positions[0].x,
                               mesh.positions.size(), sizeof(glm::vec3), target, kAnyError,
                               meshopt_SimplifyLockBorder, nullptr));
  scenes::Mesh result;
  result.material = mesh.material;
  std::vector<std::uint32_t> number(mesh.positions.size(), scenes::kNone);
  for (std::uint32_t& vertex : kept) {
    if (number[vertex] == scenes::kNone) {
      number[vertex] = static_cast<std::uint32_t>(result.positions.size());
      copy_vertex(mesh, vertex, result);
    }
    vertex = number[vertex];
  }
  std::vector<glm::vec3> middles;
  for (std::size_t i = 0; i + 2 < kept.size(); i += 3) {
    constexpr float kThird = 1.0F / 3.0F;
    middles.push_back(result.positions[kept[i]] * kThird + result.positions[kept[i + 1]] * kThird +
                      result.positions[kept[i + 2]] * kThird);
  }
  for (const std::uint32_t t : order_along_curve(middles))
    result.triangles.emplace_back(kept[3 * t], kept[3 * t + 1], kept[3 * t + 2]);
  return result;
}

float attribute_scale(const scenes::Mesh& before) { return kAttributeEdges * mean_edge(before); }

}  // namespace delray::packs::internal
