// Smallest angles beside those that arc tangents give.
#include "delaunay/construction/smallest_angles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

double angle_at(const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
  const glm::dvec2 u = q - p, v = r - p;
  return std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
}

double smallest(const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) {
  return std::min({angle_at(p, q, r), angle_at(q, r, p), angle_at(r, p, q)});
}

TEST(SmallestAngles, AreThoseOfArcTangents) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<> unit(0, 1);
  int larger = 0, decided = 0;
  while (decided < 3000) {
    std::array<glm::dvec2, 4> p;
    for (glm::dvec2& each : p) each = {unit(random), unit(random)};
    bool is_convex = true;
    for (std::size_t i = 0; i < 4; ++i) {
      is_convex = is_convex && orient2d(p[i], p[(i + 1) % 4], p[(i + 2) % 4]) > 0;
    }
    if (!is_convex) continue;
    const double now = std::min(smallest(p[0], p[1], p[2]), smallest(p[0], p[2], p[3]));
    const double then = std::min(smallest(p[1], p[2], p[3]), smallest(p[1], p[3], p[0]));
    if (std::abs(now - then) < 1e-9) continue;
    ++decided;
    larger += now > then ? 1 : 0;
    EXPECT_EQ(has_larger_angles(p[0], p[1], p[2], p[3]), now > then) << decided;
    EXPECT_EQ(has_larger_angles(p[1], p[2], p[3], p[0]), now < then) << decided;
  }
  EXPECT_GT(larger, 1000);
  EXPECT_LT(larger, 2000);
}

TEST(SmallestAngles, OnACircleAreEqual) {
  const std::array<glm::dvec2, 4> p = {{{65, 0}, {16, 63}, {-56, 33}, {-25, -60}}};
  for (const double scale : {1.0, 0x1p-1000, 0x1p1000}) {
    const auto at = [&](std::size_t i) { return scale * p[i % 4]; };
    EXPECT_FALSE(has_larger_angles(at(0), at(1), at(2), at(3)));
    EXPECT_FALSE(has_larger_angles(at(1), at(2), at(3), at(0)));
  }
}

// The fourth point an ulp off the circle of the others: inside or outside decides.
TEST(SmallestAngles, AreComparedExactly) {
  const glm::dvec2 a(65, 0), b(16, 63), c(-56, 33);
  for (const double y : {std::nextafter(-60.0, -70.0), std::nextafter(-60.0, 0.0)}) {
    const glm::dvec2 d(-25, y);
    const bool inside = incircle(a, b, c, d) > 0;
    EXPECT_EQ(has_larger_angles(b, c, d, a), inside);
    EXPECT_EQ(has_larger_angles(a, b, c, d), !inside);
  }
}

TEST(SmallestAngles, MayBeOfAnySize) {
  for (const double scale : {0x1p-1070, 0x1p-600, 0x1p600, 0x1p1020}) {
    const glm::dvec2 a(0, 0), b(scale, 0), c(2 * scale, scale), d(0, scale);
    EXPECT_TRUE(has_larger_angles(b, c, d, a) != has_larger_angles(a, b, c, d)) << scale;
    EXPECT_TRUE(has_larger_angles(b, c, d, a)) << scale;
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
