// Border places in a hash table; borders of other pieces are looked through where the boxes of both
// overlap.
//
// Degenerate: -0 and 0 are one place; a piece without a border has an empty box, which overlaps
// none.
#include "apps/pack/piece_borders.h"

#include <algorithm>
#include <bit>

namespace delray::apps {
namespace {

bool overlap(const geometry::Box3& a, const geometry::Box3& b) {
  return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

template <class T>
void resize_if_any(std::vector<T>& values, std::size_t size) {
  if (!values.empty()) values.resize(size);
}

}  // namespace

std::size_t PlaceHash::operator()(const glm::vec3& p) const {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ std::bit_cast<std::uint32_t>(p[k] + 0.0F)) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

Places border_places(std::span<const glm::vec3> positions, std::span<const std::uint8_t> shared) {
  Places places;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (shared[i] != 0) places.insert(positions[i]);
  return places;
}

PieceBorder border_of(const scenes::Mesh& piece, const Places& places) {
  std::vector<std::uint8_t> on_border(piece.positions.size());
  PieceBorder border;
  for (std::size_t i = 0; i < piece.positions.size(); ++i) {
    on_border[i] = places.contains(piece.positions[i]) ? 1 : 0;
    if (on_border[i] != 0) border.box.include(piece.positions[i]);
  }
  for (const glm::uvec3& t : piece.triangles) {
    if ((on_border[t.x] | on_border[t.y] | on_border[t.z]) != 0)
      border.triangles.push_back(
          {piece.positions[t.x], piece.positions[t.y], piece.positions[t.z]});
  }
  return border;
}

std::uint32_t add_neighbours(std::span<const PieceBorder> borders, std::size_t number,
                             const Places& places, scenes::Mesh& piece) {
  std::vector<glm::uvec3> before, behind;
  for (std::size_t i = 0; i < borders.size(); ++i) {
    if (i == number || !overlap(borders[i].box, borders[number].box)) continue;
    for (const std::array<glm::vec3, 3>& triangle : borders[i].triangles) {
      if (std::ranges::none_of(triangle, [&](const glm::vec3& p) { return places.contains(p); }))
        continue;
      const auto first = static_cast<std::uint32_t>(piece.positions.size());
      piece.positions.insert(piece.positions.end(), triangle.begin(), triangle.end());
      (i < number ? before : behind).emplace_back(first, first + 1, first + 2);
    }
  }
  resize_if_any(piece.colours, piece.positions.size());
  piece.triangles.insert(piece.triangles.begin(), before.begin(), before.end());
  piece.triangles.insert(piece.triangles.end(), behind.begin(), behind.end());
  return static_cast<std::uint32_t>(before.size());
}

}  // namespace delray::apps
