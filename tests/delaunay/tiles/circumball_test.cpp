#include "delaunay/tiles/circumball.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

geometry::Box<glm::dvec2> box_at(const glm::dvec2& p) { return {p, p}; }
geometry::Box<glm::dvec3> box_at(const glm::dvec3& p) { return {p, p}; }

template <int D>
std::array<glm::vec<D, double>, D + 1> random_corners(std::mt19937_64& random, double scale,
                                                      double away, double flatness) {
  std::uniform_real_distribution<> unit(-1, 1);
  std::array<glm::vec<D, double>, D + 1> corners;
  for (auto& corner : corners) {
    for (int k = 0; k < D; ++k) corner[k] = away + scale * unit(random) * (k == 0 ? 1 : flatness);
  }
  return corners;
}

// Every point that is in or on the ball, exactly, is touched: corners and random ones, of simplices
// of all sizes, far from the origin, and so flat that rounding decides.
TEST(Circumball, NeverMissesAPointOfTheBall) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(10, static_cast<int>(random() % 40) - 20);
    const double away = (i % 3) * 1000 * scale;
    const double flat = std::pow(10, -static_cast<int>(random() % 20));
    {
      const auto c = random_corners<2>(random, scale, away, flat);
      const Circumball<2> ball(c);
      for (const glm::dvec2& corner : c) ASSERT_TRUE(ball.touches(box_at(corner))) << i;
      const glm::dvec2 p = random_corners<2>(random, 2 * scale, away, flat)[0];
      if (incircle(c[0], c[1], c[2], p) * orient2d(c[0], c[1], c[2]) >= 0) {
        ASSERT_TRUE(ball.touches(box_at(p))) << i;
      }
    }
    const auto c = random_corners<3>(random, scale, away, flat);
    const Circumball<3> ball(c);
    for (const glm::dvec3& corner : c) ASSERT_TRUE(ball.touches(box_at(corner))) << i;
    const glm::dvec3 p = random_corners<3>(random, 2 * scale, away, flat)[0];
    if (insphere(c[0], c[1], c[2], c[3], p) * orient3d(c[0], c[1], c[2], c[3]) >= 0) {
      ASSERT_TRUE(ball.touches(box_at(p))) << i;
    }
  }
}

// A ball within a box holds no point outside, exactly.
TEST(Circumball, IsWithinBoxesThatHoldAllOfIt) {
  std::mt19937_64 random(2);
  int within = 0;
  for (int i = 0; i < 20000; ++i) {
    const double away = (i % 3) * 1000;
    const auto c = random_corners<2>(random, 1, away, 1);
    const Circumball<2> ball(c);
    const double side = std::pow(2, static_cast<int>(random() % 8) - 3);
    const geometry::Box<glm::dvec2> box{glm::dvec2(away - side), glm::dvec2(away + side)};
    if (!ball.is_within(box)) continue;
    ++within;
    const glm::dvec2 p = random_corners<2>(random, 2 * side, away, 1)[0];
    if (glm::any(glm::lessThan(p, box.low)) || glm::any(glm::greaterThan(p, box.high))) {
      ASSERT_LT(incircle(c[0], c[1], c[2], p) * orient2d(c[0], c[1], c[2]), 0) << i;
    }
  }
  EXPECT_GT(within, 1000);
  const Circumball<2> disc({glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(-1, 0)});
  EXPECT_TRUE(disc.is_within({{-1.001, -1.001}, {1.001, 1.001}}));
  EXPECT_FALSE(disc.is_within({{-0.999, -1.001}, {1.001, 1.001}}));
  const Circumball<2> line({glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(3, 3)});
  EXPECT_FALSE(line.is_within({glm::dvec2(-1e300), glm::dvec2(1e300)}));
}

TEST(Circumball, LeavesOutBoxesThatAreClearlyAway) {
  const Circumball<2> disc({glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(-1, 0)});
  EXPECT_TRUE(disc.touches({{0.8, -0.1}, {3, 0.1}}));
  EXPECT_TRUE(disc.touches({{1, -5}, {2, 5}}));
  EXPECT_FALSE(disc.touches({{1.000001, -5}, {2, 5}}));
  EXPECT_FALSE(disc.touches({{0.71, 0.71}, {2, 2}}));
  EXPECT_TRUE(disc.touches({{-9, -9}, {9, 9}}));
  const Circumball<3> ball(
      {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1)});
  EXPECT_FALSE(ball.touches({{0.6, 0.6, 0.6}, {2, 2, 2}}));
  EXPECT_TRUE(ball.touches({{0.57, 0.57, 0.57}, {2, 2, 2}}));
}

TEST(Circumball, TouchesEverythingWhenFlat) {
  const Circumball<2> line({glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(3, 3)});
  EXPECT_TRUE(line.touches(box_at(glm::dvec2(1e9, -1e12))));
  const Circumball<2> huge({glm::dvec2(0, 0), glm::dvec2(1e300, 0), glm::dvec2(0, 1e300)});
  EXPECT_TRUE(huge.touches(box_at(glm::dvec2(-1e300, 0))));
}

TEST(ReachesBeyond, IsTheClosedHalfSpaceOutside) {
  const std::array<glm::dvec2, 2> edge = {glm::dvec2(0, 0), glm::dvec2(1, 0)};
  EXPECT_TRUE(reaches_beyond(edge, {{5, -1}, {6, 1}}));
  EXPECT_TRUE(reaches_beyond(edge, {{5, 0}, {6, 1}}));
  EXPECT_FALSE(reaches_beyond(edge, {{5, 1e-300}, {6, 1}}));
  const std::array<glm::dvec3, 3> face = {glm::dvec3(0, 0, 0), glm::dvec3(0, 1, 0),
                                          glm::dvec3(1, 0, 0)};  // seen from below
  EXPECT_TRUE(reaches_beyond(face, {{5, 5, -1}, {6, 6, 1}}));
  EXPECT_TRUE(reaches_beyond(face, {{5, 5, 0}, {6, 6, 1}}));
  EXPECT_FALSE(reaches_beyond(face, {{5, 5, 1e-300}, {6, 6, 1}}));
}

}  // namespace
}  // namespace delray::delaunay
