// Quadric edge collapses by meshoptimizer (after Garland and Heckbert 1997), with the border
// locked; the error is measured afterwards, since theirs is no bound. Triangles are then ordered
// along a Morton curve, so that pages of consecutive ones are compact.
#include "packs/build/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "packs/build/surface_error.h"

namespace delray::packs::internal {
namespace {

// How far a difference of 1 between normals, colours or texture coordinates is, in edges of the
// mesh.
constexpr float kAttributeEdges = 0.25F;

template <class T>
void append_value(const std::vector<T>& values, std::size_t i, std::string& key) {
  if (!values.empty()) key.append(reinterpret_cast<const char*>(&values[i]), sizeof(T));
}

std::string key_of(const scenes::Mesh& mesh, std::size_t i) {
  std::string key;
  append_value(mesh.positions, i, key);
  append_value(mesh.normals, i, key);
  append_value(mesh.uvs, i, key);
  append_value(mesh.uvs2, i, key);
  append_value(mesh.tangents, i, key);
  append_value(mesh.colours, i, key);
  return key;
}

template <class T>
void copy_value(const std::vector<T>& from, std::size_t i, std::vector<T>& to) {
  if (!from.empty()) to.push_back(from[i]);
}

void copy_vertex(const scenes::Mesh& from, std::size_t i, scenes::Mesh& to) {
  copy_value(from.positions, i, to.positions);
  copy_value(from.normals, i, to.normals);
  copy_value(from.uvs, i, to.uvs);
  copy_value(from.uvs2, i, to.uvs2);
  copy_value(from.tangents, i, to.tangents);
  copy_value(from.colours, i, to.colours);
}

std::uint64_t spread(std::uint32_t bits) {  // of 21: two zeros between each and the next
  std::uint64_t x = bits;
  x = (x | x << 32) & 0x1F00000000FFFFULL;
  x = (x | x << 16) & 0x1F0000FF0000FFULL;
  x = (x | x << 8) & 0x100F00F00F00F00FULL;
  x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

// Along a Morton curve, of equal places in the order of before.
void order_along_curve(scenes::Mesh& mesh) {
  geometry::Box3 box;
  for (const glm::vec3& p : mesh.positions) box.include(p);
  const glm::vec3 size = box.size();
  const float longest = std::max({size.x, size.y, size.z});
  constexpr float kCells = 2097151.0F;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& v = mesh.triangles[t];
    const glm::vec3 middle =
        (mesh.positions[v.x] + mesh.positions[v.y] + mesh.positions[v.z]) * (1.0F / 3.0F);
    const glm::vec3 cell = longest > 0
                               ? glm::clamp((middle - box.low) * (kCells / longest), 0.0F, kCells)
                               : glm::vec3(0.0F);
    keys.emplace_back(spread(static_cast<std::uint32_t>(cell.x)) |
                          spread(static_cast<std::uint32_t>(cell.y)) << 1 |
                          spread(static_cast<std::uint32_t>(cell.z)) << 2,
                      t);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<glm::uvec3> ordered;
  ordered.reserve(keys.size());
  for (const auto& [key, t] : keys) ordered.push_back(mesh.triangles[t]);
  mesh.triangles = std::move(ordered);
}

}  // namespace

scenes::Mesh merge(std::span<const Page> pages) {
  scenes::Mesh mesh;
  std::unordered_map<std::string, std::uint32_t> known;
  std::vector<std::uint32_t> number;
  for (const Page& page : pages) {
    mesh.material = page.mesh.material;
    number.clear();
    for (std::size_t i = 0; i < page.mesh.positions.size(); ++i) {
      const auto [found, is_new] =
          known.emplace(key_of(page.mesh, i), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) copy_vertex(page.mesh, i, mesh);
      number.push_back(found->second);
    }
    for (const glm::uvec3& t : page.mesh.triangles)
      mesh.triangles.emplace_back(number[t.x], number[t.y], number[t.z]);
  }
  return mesh;
}

Simplified simplify(const scenes::Mesh& mesh) {
  const std::size_t corners = 3 * mesh.triangles.size();
  std::vector<std::uint32_t> kept(corners);
  constexpr float kAnyError = 1e30F;
  kept.resize(meshopt_simplify(kept.data(), &mesh.triangles[0].x, corners, &mesh.positions[0].x,
                               mesh.positions.size(), sizeof(glm::vec3), corners / 6 * 3, kAnyError,
                               meshopt_SimplifyLockBorder, nullptr));
  Simplified result;
  result.mesh.material = mesh.material;
  std::vector<std::uint32_t> number(mesh.positions.size(), scenes::kNone);
  for (std::uint32_t& vertex : kept) {
    if (number[vertex] == scenes::kNone) {
      number[vertex] = static_cast<std::uint32_t>(result.mesh.positions.size());
      copy_vertex(mesh, vertex, result.mesh);
    }
    vertex = number[vertex];
  }
  for (std::size_t i = 0; i + 2 < kept.size(); i += 3)
    result.mesh.triangles.emplace_back(kept[i], kept[i + 1], kept[i + 2]);
  order_along_curve(result.mesh);
  result.error = surface_error(mesh, result.mesh, kAttributeEdges * mean_edge(mesh));
  return result;
}

}  // namespace delray::packs::internal
