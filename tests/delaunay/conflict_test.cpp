#include "delaunay/conflict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/delaunay/brute_force.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

TEST(Conflict, FollowsTheRuleForPointsOnACommonCircle) {
  int cocircular = 0;
  for (const HardPoints& kind : hard_points()) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Points p = kind.make(4, seed);
      Simplex<2> triangle = {p[0], p[1], p[2]};
      const int turn = orient(triangle);
      if (turn == 0 || std::ranges::find(triangle, p[3]) != triangle.end()) continue;
      if (turn < 0) std::swap(triangle[0], triangle[1]);
      EXPECT_EQ(circle_conflict(triangle[0], triangle[1], triangle[2], p[3]),
                counts_as_inside<2>(triangle, p[3]))
          << kind.name << ", seed " << seed;
      cocircular += in_sphere(triangle, p[3]) == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(cocircular, 100);
}

// Of a quadrilateral on a circle exactly one diagonal may be seen as Delaunay, from either side.
TEST(Conflict, TheDiagonalOfASquareIsUnique) {
  const std::array<glm::dvec2, 4> square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const auto flips = [&](std::size_t i) {
    return circle_conflict(square[i], square[(i + 1) % 4], square[(i + 2) % 4],
                           square[(i + 3) % 4]);
  };
  EXPECT_EQ(flips(0), flips(2));
  EXPECT_EQ(flips(1), flips(3));
  EXPECT_NE(flips(0), flips(1));
}

TEST(Conflict, AGhostConflictsBeyondItsEdgeAndStrictlyWithinIt) {
  const std::vector<glm::dvec2> points = {{0, 0}, {4, 2}};
  for (unsigned infinite = 0; infinite < 3; ++infinite) {
    Mesh<2> mesh(1);
    mesh.set_vertex(corner_of(0, infinite), kInfiniteVertex);
    mesh.set_vertex(corner_of(0, (infinite + 1) % 3), 0);
    mesh.set_vertex(corner_of(0, (infinite + 2) % 3), 1);
    EXPECT_TRUE(conflict(mesh, points, 0, {0, 5}));
    EXPECT_TRUE(conflict(mesh, points, 0, {-90, 0}));
    EXPECT_FALSE(conflict(mesh, points, 0, {5, 0}));
    EXPECT_TRUE(conflict(mesh, points, 0, {2, 1}));
    EXPECT_FALSE(conflict(mesh, points, 0, {6, 3}));
    EXPECT_FALSE(conflict(mesh, points, 0, {-2, -1}));
  }
}

}  // namespace
}  // namespace delray::delaunay
