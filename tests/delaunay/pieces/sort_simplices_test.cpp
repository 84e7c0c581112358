#include "delaunay/pieces/sort_simplices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

namespace delray::delaunay::internal {
namespace {

// Whether the order of b is an even permutation of that of a.
template <std::size_t N>
bool same_orientation(std::array<std::uint32_t, N> a, const std::array<std::uint32_t, N>& b) {
  bool even = true;
  for (std::size_t i = 0; i < N; ++i) {
    const auto at = static_cast<std::size_t>(std::ranges::find(a, b[i]) - a.begin());
    if (at == i) continue;
    std::swap(a[at], a[i]);
    even = !even;
  }
  return even;
}

template <std::size_t N>
void expect_one_turn() {
  std::array<std::uint32_t, N> start;
  for (std::size_t i = 0; i < N; ++i) start[i] = static_cast<std::uint32_t>(7 * i + 3);
  std::set<std::array<std::uint32_t, N>> turned;
  auto order = start;
  do {
    auto simplex = order;
    turn_to_lowest(simplex);
    EXPECT_TRUE(same_orientation(order, simplex));
    EXPECT_EQ(simplex[0], start[0]);
    if (N == 4) {
      EXPECT_EQ(simplex[1], start[1]);
    }
    turned.insert(simplex);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(turned.size(), 2U);  // one for each orientation
}

TEST(SortSimplices, TurnsToOneOrderForEachOrientation) {
  expect_one_turn<3>();
  expect_one_turn<4>();
}

template <std::size_t N>
void expect_sorted(std::uint32_t seed) {
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const std::uint32_t first = random() % 1000, rows = 1 + random() % 50;
  std::vector<std::array<std::uint32_t, N>> wanted(random() % 300);
  std::vector<std::uint32_t> given;
  for (auto& simplex : wanted) {
    simplex[0] = first + random() % rows;
    for (std::size_t k = 1; k < N; ++k) simplex[k] = simplex[k - 1] + 1 + random() % 9;
    given.insert(given.end(), simplex.begin(), simplex.end());
  }
  std::ranges::sort(wanted);
  std::vector<std::uint32_t> expected;
  for (const auto& simplex : wanted)
    expected.insert(expected.end(), simplex.begin(), simplex.end());
  EXPECT_EQ(sort_simplices(given, N, first, rows), expected);
}

TEST(SortSimplices, SortsByRows) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    expect_sorted<3>(seed);
    expect_sorted<4>(seed);
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
