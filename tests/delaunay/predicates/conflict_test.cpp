// The rule for ties, and conflicts with ghosts.
#include "delaunay/predicates/conflict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/delaunay/brute_force.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/hard_points_3d.h"

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

TEST(Conflict, FollowsTheRuleForPointsOnACommonSphere) {
  int cospherical = 0;
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const std::vector<glm::dvec3> p = kind.make(5, seed);
      Mesh<3> mesh(1);
      Simplex<3> simplex = {p[0], p[1], p[2], p[3]};
      const int turn = orient(simplex);
      if (turn == 0 || std::ranges::find(simplex, p[4]) != simplex.end()) continue;
      for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(0, k), k);
      if (turn < 0) {
        std::swap(simplex[0], simplex[1]);
        mesh.set_vertex(corner_of(0, 0), 1);
        mesh.set_vertex(corner_of(0, 1), 0);
      }
      EXPECT_EQ(conflict(mesh, p, 0, p[4]), counts_as_inside<3>(simplex, p[4]))
          << kind.name << ", seed " << seed;
      cospherical += in_sphere(simplex, p[4]) == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(cospherical, 100);
}

// Beyond its facet always, in the plane of the facet as the rule says for its circle.
TEST(Conflict, AGhostConflictsBeyondItsFacetAndWithinItsCircle) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 3}};
  for (unsigned infinite = 0; infinite < 4; ++infinite) {
    Mesh<3> mesh(2);
    for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(0, k), k);
    // The ghost below the first three, whose order is turned by even permutations only.
    constexpr std::array<std::array<VertexNumber, 4>, 4> kGhosts = {{
        {kInfiniteVertex, 0, 1, 2},
        {0, kInfiniteVertex, 2, 1},
        {0, 1, kInfiniteVertex, 2},
        {0, 2, 1, kInfiniteVertex},
    }};
    for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(1, k), kGhosts[infinite][k]);
    mesh.link(corner_of(1, infinite), corner_of(0, 3));
    EXPECT_TRUE(conflict(mesh, points, 1, {1, 1, -1})) << infinite;
    EXPECT_TRUE(conflict(mesh, points, 1, {90, 7, -1})) << infinite;
    EXPECT_FALSE(conflict(mesh, points, 1, {1, 1, 1})) << infinite;
    EXPECT_TRUE(conflict(mesh, points, 1, {1, 1, 0})) << infinite;
    EXPECT_TRUE(conflict(mesh, points, 1, {3.5, 3.5, 0})) << infinite;
    EXPECT_FALSE(conflict(mesh, points, 1, {4.5, 4.5, 0})) << infinite;
    EXPECT_FALSE(conflict(mesh, points, 1, {4, 4, 0})) << infinite;  // on it, and the last of all
  }
}

}  // namespace
}  // namespace delray::delaunay
