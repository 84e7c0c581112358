#include "delaunay/tiles/deep_ball.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

template <int D>
using Place = glm::vec<D, double>;

// 1 inside, 0 on, -1 outside of the ball through the corners.
int side(const std::array<glm::dvec2, 3>& c, const glm::dvec2& p) {
  return incircle(c[0], c[1], c[2], p) * orient2d(c[0], c[1], c[2]);
}
int side(const std::array<glm::dvec3, 4>& c, const glm::dvec3& p) {
  return insphere(c[0], c[1], c[2], c[3], p) * orient3d(c[0], c[1], c[2], c[3]);
}

// Balls that are deep have nothing on or beyond the border, exactly: points on the planes of the
// box nearest to the ball decide. Simplices of all sizes, far from the origin, and flat.
template <int D>
int count_deep(std::mt19937_64& random) {
  std::uniform_real_distribution<> unit(-1, 1);
  int deep = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(10, static_cast<int>(random() % 40) - 20);
    const double away = (i % 3) * 1000 * scale;
    const double flat = std::pow(10, -static_cast<int>(random() % 12) / 2);
    std::array<Place<D>, D + 1> corners;
    Place<D> middle(0);
    for (auto& corner : corners) {
      for (int k = 0; k < D; ++k) corner[k] = away + scale * unit(random) * (k == 0 ? 1 : flat);
      middle += corner / double(D + 1);
    }
    const double half = scale * std::pow(2, static_cast<int>(random() % 12) - 2);
    const geometry::Box<Place<D>> box{middle - half, middle + half};
    if (!is_deep<D>(corners, box)) continue;
    ++deep;
    for (int j = 0; j < 20; ++j) {
      Place<D> p;
      for (int k = 0; k < D; ++k) p[k] = middle[k] + half * unit(random);
      const int axis = static_cast<int>(random() % D);
      p[axis] = random() % 2 == 0 ? box.low[axis] : box.high[axis];
      if (side(corners, p) >= 0) {
        ADD_FAILURE() << D << "D, simplex " << i;
        return deep;
      }
    }
  }
  return deep;
}

TEST(IsDeep, NeverHoldsForABallThatReachesTheBorder) {
  std::mt19937_64 random(3);
  EXPECT_GT(count_deep<2>(random), 2000);
  EXPECT_GT(count_deep<3>(random), 500);
}

TEST(IsDeep, HoldsForSmallBallsInLargeBoxes) {
  const std::array<glm::dvec2, 3> triangle = {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)};
  EXPECT_TRUE(is_deep<2>(triangle, {glm::dvec2(-1.5), glm::dvec2(1.5)}));
  EXPECT_FALSE(is_deep<2>(triangle, {glm::dvec2(-1.4), glm::dvec2(1.4)}));
  EXPECT_FALSE(is_deep<2>(triangle, geometry::Box<glm::dvec2>{}));
  const std::array<glm::dvec2, 3> line = {glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(2, 2)};
  EXPECT_FALSE(is_deep<2>(line, {glm::dvec2(-1e300), glm::dvec2(1e300)}));
  const std::array<glm::dvec2, 3> tiny = {glm::dvec2(0, 0), glm::dvec2(1e-200, 0),
                                          glm::dvec2(0, 1e-200)};
  EXPECT_FALSE(is_deep<2>(tiny, {glm::dvec2(-1), glm::dvec2(1)}));  // numbers underflow
}

}  // namespace
}  // namespace delray::delaunay
