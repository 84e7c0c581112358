// An order of simplices that depends on nothing but their rows.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace delray::delaunay::internal {

// Turns a simplex, in place, to begin with its lowest row and, in space, to go on with the lowest
// of the others, without changing its orientation. REQUIRES: three or four rows, which are
// distinct.
inline void turn_to_lowest(std::array<std::uint32_t, 3>& t) {
  const auto [a, b, c] = t;
  if (a < b && a < c) return;
  t = b < c ? std::array{b, c, a} : std::array{c, a, b};
}
inline void turn_to_lowest(std::array<std::uint32_t, 4>& t) {
  const auto lowest = static_cast<std::size_t>(std::ranges::min_element(t) - t.begin());
  // Two exchanges leave the orientation as it is, and so does turning three corners.
  if (lowest != 0) {
    std::swap(t[0], t[lowest]);
    std::swap(t[lowest == 1 ? 2 : 1], t[lowest == 3 ? 2 : 3]);
  }
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
}

// Sorts turned simplices of `corners` rows each by their rows. Lowest rows are in [first, first +
// rows). O(n + rows) where few simplices have the same lowest row, with two copies of them.
std::vector<std::uint32_t> sort_simplices(std::span<const std::uint32_t> simplices, int corners,
                                          std::uint64_t first, std::uint64_t rows);

}  // namespace delray::delaunay::internal
