// A counting sort by lowest rows, then comparisons among those of one row.
#include "delaunay/pieces/sort_simplices.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace delray::delaunay::internal {
namespace {

// What tells simplices of one lowest row apart: the other rows, in their order.
template <std::size_t Corners>
struct OtherRows {
  using Key = std::array<std::uint32_t, Corners - 1>;
  static Key key(const std::uint32_t* simplex) {
    Key key;
    std::copy_n(simplex + 1, Corners - 1, key.begin());
    return key;
  }
  static void put(const Key& key, std::uint32_t* simplex) { std::ranges::copy(key, simplex + 1); }
};
// Two rows are a number that is compared at once.
template <>
struct OtherRows<3> {
  using Key = std::uint64_t;
  static Key key(const std::uint32_t* simplex) { return Key{simplex[1]} << 32 | simplex[2]; }
  static void put(Key key, std::uint32_t* simplex) {
    simplex[1] = static_cast<std::uint32_t>(key >> 32);
    simplex[2] = static_cast<std::uint32_t>(key);
  }
};

// By insertion where there are few.
template <class Key>
void sort_keys(std::span<Key> keys) {
  constexpr std::size_t kFew = 24;
  if (keys.size() > kFew) {
    std::ranges::sort(keys);
    return;
  }
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Key key = keys[i];
    std::size_t at = i;
    for (; at > 0 && key < keys[at - 1]; --at) keys[at] = keys[at - 1];
    keys[at] = key;
  }
}

template <std::size_t Corners>
std::vector<std::uint32_t> sort_by_rows(std::span<const std::uint32_t> simplices,
                                        std::uint64_t first, std::uint64_t rows) {
  using Other = OtherRows<Corners>;
  const std::size_t n = simplices.size() / Corners;
  std::vector<std::uint32_t> ends(rows + 1);  // of the run of each row
  for (std::size_t i = 0; i < n; ++i) ++ends[simplices[i * Corners] - first];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : ends) sum += std::exchange(end, sum);
  std::vector<typename Other::Key> keys(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t* const simplex = &simplices[i * Corners];
    keys[ends[*simplex - first]++] = Other::key(simplex);
  }
  std::vector<std::uint32_t> sorted(simplices.size());
  std::size_t at = 0;
  for (std::uint64_t row = 0; row < rows; ++row) {
    sort_keys(std::span(keys).subspan(at, ends[row] - at));
    for (; at < ends[row]; ++at) {
      sorted[at * Corners] = static_cast<std::uint32_t>(first + row);
      Other::put(keys[at], &sorted[at * Corners]);
    }
  }
  return sorted;
}

}  // namespace

std::vector<std::uint32_t> sort_simplices(std::span<const std::uint32_t> simplices, int corners,
                                          std::uint64_t first, std::uint64_t rows) {
  return corners == 3 ? sort_by_rows<3>(simplices, first, rows)
                      : sort_by_rows<4>(simplices, first, rows);
}

}  // namespace delray::delaunay::internal
