// Places are sorted by the interleaved bits of their cells, 2^21 along the longest side of the box.
//
// Degenerate: places that are all equal keep their order.
#include "packs/build/vertices.h"

#include <algorithm>

#include "geometry/box.h"

namespace delray::packs::internal {
namespace {

template <class T>
void copy_value(const std::vector<T>& from, std::size_t i, std::vector<T>& to) {
  if (!from.empty()) to.push_back(from[i]);
}

std::uint64_t spread(std::uint32_t bits) {  // of 21: two zeros between each and the next
  std::uint64_t x = bits;
  x = (x | x << 32) & 0x1F00000000FFFFULL;
  x = (x | x << 16) & 0x1F0000FF0000FFULL;
  x = (x | x << 8) & 0x100F00F00F00F00FULL;
  x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

}  // namespace

void copy_vertex(const scenes::Mesh& from, std::size_t i, scenes::Mesh& to) {
  copy_value(from.positions, i, to.positions);
  copy_value(from.normals, i, to.normals);
  copy_value(from.uvs, i, to.uvs);
  copy_value(from.uvs2, i, to.uvs2);
  copy_value(from.tangents, i, to.tangents);
  copy_value(from.colours, i, to.colours);
}

std::vector<std::uint32_t> order_along_curve(std::span<const glm::vec3> places) {
  geometry::Box3 box;
  for (const glm::vec3& p : places) box.include(p);
  const glm::vec3 size = box.size();
  const float longest = std::max({size.x, size.y, size.z});
  constexpr float kCells = 2097151.0F;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(places.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const glm::vec3 cell =
        longest > 0 ? glm::clamp((places[i] - box.low) * (kCells / longest), 0.0F, kCells)
                    : glm::vec3(0.0F);
    keys.emplace_back(spread(static_cast<std::uint32_t>(cell.x)) |
                          spread(static_cast<std::uint32_t>(cell.y)) << 1 |
                          spread(static_cast<std::uint32_t>(cell.z)) << 2,
                      i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& [key, i] : keys) order.push_back(i);
  return order;
}

}  // namespace delray::packs::internal
