// A counting sort by lowest rows, then comparisons among those of one row.
#include "delaunay/pieces/sort_simplices.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace delray::delaunay::internal {
namespace {

template <std::size_t Corners>
std::vector<std::uint32_t> sort_by_rows(std::span<const std::uint32_t> simplices,
                                        std::uint64_t first, std::uint64_t rows) {
  using Simplex = std::array<std::uint32_t, Corners>;
  static_assert(sizeof(Simplex) == Corners * sizeof(std::uint32_t));
  const std::size_t n = simplices.size() / Corners;
  std::vector<std::uint32_t> ends(rows + 1);  // of the run of each row
  for (std::size_t i = 0; i < n; ++i) ++ends[simplices[i * Corners] - first];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : ends) sum += std::exchange(end, sum);
  std::vector<std::uint32_t> sorted(simplices.size());
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t* const simplex = &simplices[i * Corners];
    std::copy_n(simplex, Corners, &sorted[std::size_t{ends[*simplex - first]++} * Corners]);
  }
  auto* const begin = reinterpret_cast<Simplex*>(sorted.data());
  std::uint32_t at = 0;
  for (const std::uint32_t end : ends) {
    std::sort(begin + at, begin + end);
    at = end;
  }
  return sorted;
}

}  // namespace

void turn_to_lowest(std::span<std::uint32_t> simplex) {
  const auto lowest = std::ranges::min_element(simplex) - simplex.begin();
  if (simplex.size() == 3) {
    std::ranges::rotate(simplex, simplex.begin() + lowest);
    return;
  }
  // Two exchanges leave the orientation as it is, and so does turning three corners.
  if (lowest != 0) {
    std::swap(simplex[0], simplex[static_cast<std::size_t>(lowest)]);
    const std::size_t other = lowest == 1 ? 2 : 1;
    std::swap(simplex[other], simplex[lowest == 3 ? 2 : 3]);
  }
  const auto rest = simplex.subspan(1);
  std::ranges::rotate(rest, std::ranges::min_element(rest));
}

std::vector<std::uint32_t> sort_simplices(std::span<const std::uint32_t> simplices, int corners,
                                          std::uint64_t first, std::uint64_t rows) {
  return corners == 3 ? sort_by_rows<3>(simplices, first, rows)
                      : sort_by_rows<4>(simplices, first, rows);
}

}  // namespace delray::delaunay::internal
