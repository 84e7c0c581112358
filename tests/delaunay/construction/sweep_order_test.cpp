// The order of a sweep's events, beside the same computed with 300 digits.
#include "delaunay/construction/sweep_order.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>

#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

using Long = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<300>>;

// Nothing of small integers that is not 0 is as small.
int long_sign(const Long& x) { return abs(x) < Long("1e-200") ? 0 : x < 0 ? -1 : 1; }

Long long_top(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const Long bx = Long(b.x) - a.x, by = Long(b.y) - a.y, cx = Long(c.x) - a.x, cy = Long(c.y) - a.y;
  const Long d = 2 * (bx * cy - by * cx);
  const Long x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
  const Long y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
  return a.y + y + sqrt(x * x + y * y);
}

// Where the parabola of p ends and that of q begins: of the two places that see p, q and the line
// at one distance the one with p's arc on its left.
Long long_meeting(const glm::dvec2& p, const glm::dvec2& q, double line) {
  const Long e = Long(line) - p.y, f = Long(line) - q.y;
  if (e == f) return (Long(p.x) + q.x) / 2;
  // (x - p.x)^2 f + e^2 f = (x - q.x)^2 e + f^2 e
  const Long a = f - e, b = 2 * (Long(q.x) * e - Long(p.x) * f);
  const Long c = Long(p.x) * p.x * f + e * e * f - Long(q.x) * q.x * e - f * f * e;
  const Long root = sqrt(b * b - 4 * a * c);
  // Above, p's parabola ends: what is negative turns positive there, which is where it rises.
  return (-b + root) / (2 * a);
}

glm::dvec2 random_point(std::mt19937_64& random, unsigned size, double unit) {
  return glm::dvec2(static_cast<double>(random() % size), static_cast<double>(random() % size)) *
         unit;
}

TEST(SweepOrder, ParabolasMeetWhereTheyShould) {
  std::mt19937_64 random(1);
  int equal = 0;
  for (int i = 0; i < 4000; ++i) {
    const double unit = i % 2 == 0 ? 1 : 0x1p-30;
    const glm::dvec2 p = random_point(random, 8, unit), q = random_point(random, 8, unit);
    glm::dvec2 s = random_point(random, 8, unit);
    s.y += 8 * unit;
    if (p == q) continue;
    if (p.y == q.y && p.x > q.x) continue;
    const int side = long_sign((long_meeting(p, q, s.y) - s.x) / unit);
    equal += side == 0 ? 1 : 0;
    if (side != 0) {
      EXPECT_EQ(meet_left_of(p, q, s), side < 0) << i;
    }
  }
  EXPECT_GT(equal, 10);
}

TEST(SweepOrder, PointsOnTheLineHaveArcsWithoutWidth) {
  EXPECT_TRUE(meet_left_of({0, 1}, {1, 1}, {2, 1}));
  EXPECT_FALSE(meet_left_of({3, 1}, {1, 0}, {2, 1}));
  EXPECT_TRUE(meet_left_of({1, 0}, {1.5, 1}, {2, 1}));
}

TEST(SweepOrder, TopsOfCirclesCompareExactly) {
  std::mt19937_64 random(2);
  int equal = 0;
  for (int i = 0; i < 4000; ++i) {
    const unsigned size = i % 2 == 0 ? 5 : 1000000;
    std::array<glm::dvec2, 6> p;
    for (glm::dvec2& each : p) each = random_point(random, size, 1);
    // Circles about one centre, and the same circle by other points.
    if (i % 4 == 0) p = {{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {4, 4}}};
    if (i % 4 == 0) p[3] += glm::dvec2(i % 8 == 0 ? 0 : 0x1p-48, 0);
    if (orient2d(p[0], p[1], p[2]) <= 0 || orient2d(p[3], p[4], p[5]) <= 0) continue;
    const TopOfCircle first(p[0], p[1], p[2]), second(p[3], p[4], p[5]);
    const Long top = long_top(p[0], p[1], p[2]), other = long_top(p[3], p[4], p[5]);
    const int sign = long_sign(top - other);
    equal += sign == 0 ? 1 : 0;
    EXPECT_EQ(first.compare(second), sign) << i;
    EXPECT_EQ(second.compare(first), -sign) << i;
    const double near = static_cast<double>(top);
    EXPECT_EQ(first.compare(near), long_sign(top - near)) << i;
  }
  EXPECT_GT(equal, 100);
}

TEST(SweepOrder, FiveOnACircleReachItsTopAtOnce) {
  // Centre 0, radius 25: a rational top.
  const TopOfCircle circle({-7, -24}, {24, -7}, {-24, 7});
  EXPECT_EQ(circle.compare(25.0), 0);
  EXPECT_EQ(circle.compare(std::nextafter(25.0, 26.0)), -1);
  EXPECT_EQ(circle.compare(std::nextafter(25.0, 24.0)), 1);
  EXPECT_EQ(circle.compare(TopOfCircle({7, -24}, {15, 20}, {-15, 20})), 0);
}

}  // namespace
}  // namespace delray::delaunay::internal
