// Each edge of a tetrahedron's surface is paired with its other use, whichever way round it is.
#include "delaunay/mesh/edge_pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace delray::delaunay::internal {
namespace {

TEST(EdgePairs, PairsTheTwoUsesOfEachEdge) {
  const std::array<std::array<std::uint32_t, 3>, 4> sides = {
      {{7, 3, 0xffffffffU}, {3, 7, 0}, {7, 0xffffffffU, 0}, {0xffffffffU, 3, 0}}};
  EdgePairs<std::size_t> pairs(12);
  for (std::size_t i = 0; i < 12; ++i) pairs.add(sides[i / 3][i % 3], sides[i / 3][(i + 1) % 3], i);
  const auto ends = [&](std::size_t i) {
    return std::set<std::uint32_t>{sides[i / 3][i % 3], sides[i / 3][(i + 1) % 3]};
  };
  std::set<std::set<std::uint32_t>> edges;
  pairs.for_each([&](std::size_t i, std::size_t j) {
    EXPECT_NE(i / 3, j / 3);
    EXPECT_EQ(ends(i), ends(j));
    edges.insert(ends(i));
  });
  EXPECT_EQ(edges.size(), 6U);
}

}  // namespace
}  // namespace delray::delaunay::internal
