#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scenes/internal/polygon.h"

namespace delray::scenes::internal {
namespace {

std::vector<glm::uvec3> triangulate(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < positions.size(); ++i) corners.push_back(i);
  std::vector<glm::uvec3> triangles;
  triangulate_polygon(corners, positions, triangles);
  return triangles;
}

TEST(Polygon, AConvexOneBecomesAFan) {
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(triangulate({{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}),
            (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, ADartIsCutAtItsNotch) {
  const auto triangles = triangulate({{0, 0, 0}, {2, 0, 0}, {0.4F, 0.4F, 0}, {0, 2, 0}});
  ASSERT_EQ(triangles.size(), 2U);
  for (const glm::uvec3& t : triangles) {
    EXPECT_TRUE(t.x == 0 || t.y == 0 || t.z == 0);
    EXPECT_TRUE(t.x == 2 || t.y == 2 || t.z == 2);
  }
}

// Stars around a centre are simple; triangles that keep the polygon's sense and add up to its area
// cover it.
TEST(Polygon, RandomStarsAreCoveredInAnyPlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 40;
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) - 0.5);
    const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, -0.8, 0.52)));
    const glm::dvec3 v = glm::cross(normal, u);
    std::vector<glm::vec3> positions;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n, radius = 0.2 + unit(random);
      positions.emplace_back(u * (radius * std::cos(angle)) + v * (radius * std::sin(angle)));
    }
    const auto area = [&](std::size_t a, std::size_t b, std::size_t c) {
      return 0.5 * glm::dot(normal, glm::cross(glm::dvec3(positions[b] - positions[a]),
                                               glm::dvec3(positions[c] - positions[a])));
    };
    double whole = 0, covered = 0;
    for (std::size_t i = 1; i + 1 < positions.size(); ++i) whole += area(0, i, i + 1);
    const auto triangles = triangulate(positions);
    ASSERT_EQ(triangles.size(), positions.size() - 2);
    for (const glm::uvec3& t : triangles) {
      ASSERT_GT(area(t.x, t.y, t.z), -1e-6) << "trial " << trial;
      covered += area(t.x, t.y, t.z);
    }
    ASSERT_NEAR(covered, whole, 1e-5) << "trial " << trial;
  }
}

TEST(Polygon, DegenerateAndHugeOnesStillGiveAllTriangles) {
  EXPECT_EQ(triangulate(std::vector<glm::vec3>(7, glm::vec3(1, 2, 3))).size(), 5U);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}}).size(), 3U);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2U);
  std::vector<glm::vec3> zigzag;
  for (int i = 0; i < 5000; ++i) zigzag.emplace_back(i, i % 2, 0);
  EXPECT_EQ(triangulate(zigzag).size(), 4998U);
}

}  // namespace
}  // namespace delray::scenes::internal
