// The table of triangulations of four points.
#include "delaunay/flip/four_points.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/glm.hpp>
#include <random>

#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

TEST(FourPoints, NeighboursShareAFacet) {
  int count = 0;
  for (const FourPoints& of : kFourPoints) {
    if (!of.exists) continue;
    ++count;
    for (unsigned i = 0; i < 18; ++i) {
      const unsigned t = i / 3, k = i % 3, mate = of.neighbours[i];
      const unsigned u = mate / 4, m = mate % 4;
      ASSERT_LT(u, 6U);
      ASSERT_LT(m, 3U);
      EXPECT_EQ(of.neighbours[3 * u + m], 4 * t + k);
      EXPECT_EQ(of.vertices[3 * t + (k + 1) % 3], of.vertices[3 * u + (m + 2) % 3]);
      EXPECT_EQ(of.vertices[3 * t + (k + 2) % 3], of.vertices[3 * u + (m + 1) % 3]);
    }
    for (unsigned point = 0; point < 4; ++point) {
      const unsigned ghost = of.ghosts[point];
      if (ghost == 0) continue;
      EXPECT_EQ(of.vertices[3 * ghost + 1], point);
      EXPECT_EQ(of.vertices[3 * ghost + 2], 4);
    }
  }
  // All but two of the sixteen ways in which four triples can turn, each with both circles.
  EXPECT_EQ(count, 28);
}

TEST(FourPoints, TrianglesAreThoseOfDelaunay) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 2000; ++round) {
    std::array<glm::dvec2, 4> p;
    for (glm::dvec2& q : p) q = {unit(random), unit(random)};
    unsigned index = 0;
    index |= orient2d(p[0], p[1], p[2]) > 0 ? 1 : 0;
    index |= orient2d(p[0], p[1], p[3]) > 0 ? 2 : 0;
    index |= orient2d(p[0], p[2], p[3]) > 0 ? 4 : 0;
    index |= orient2d(p[1], p[2], p[3]) > 0 ? 8 : 0;
    const int circle = incircle(p[0], p[1], p[2], p[3]);
    index |= ((index & 1) != 0 ? circle : -circle) > 0 ? 16 : 0;
    const FourPoints& of = kFourPoints[index];
    ASSERT_TRUE(of.exists) << index;
    for (unsigned t = 0; t < 6; ++t) {
      const unsigned a = of.vertices[3 * t], b = of.vertices[3 * t + 1], c = of.vertices[3 * t + 2];
      for (unsigned q = 0; q < 4; ++q) {
        if (q == a || q == b || q == c) continue;
        if (c == 4) {
          EXPECT_LT(orient2d(p[a], p[b], p[q]), 0) << "a point beyond the hull, " << index;
        } else {
          EXPECT_LT(incircle(p[a], p[b], p[c], p[q]), 0) << index;
        }
      }
      if (c != 4) {
        EXPECT_GT(orient2d(p[a], p[b], p[c]), 0) << index;
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
