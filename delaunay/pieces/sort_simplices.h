// An order of simplices that depends on nothing but their rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace delray::delaunay::internal {

// Turns a simplex, in place, to begin with its lowest row and, in space, to go on with the lowest
// of the others, without changing its orientation. REQUIRES: three or four rows, which are
// distinct.
void turn_to_lowest(std::span<std::uint32_t> simplex);

// Sorts turned simplices of `corners` rows each by their rows. Lowest rows are in [first, first +
// rows). O(n + rows) where few simplices have the same lowest row, with a copy of them.
std::vector<std::uint32_t> sort_simplices(std::span<const std::uint32_t> simplices, int corners,
                                          std::uint64_t first, std::uint64_t rows);

}  // namespace delray::delaunay::internal
