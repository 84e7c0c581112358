// Bounds on the display. What IceT itself answers for such bounds is compared by icet/answers.
#include "icet/viewport.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace delray::icet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr geometry::Rect kDisplay{10, 20, 110, 220};

Projected project_all(const std::vector<glm::dvec3>& bounds) {
  return project(bounds, glm::dmat4(1), kDisplay);
}

}  // namespace

TEST(Viewport, CutsBoundsAtTheDisplay) {
  const Projected seen = project_all({{-0.5, -2, 0}, {0.5, 0.5, 0.25}});
  EXPECT_EQ(seen.rect, (geometry::Rect{35, 20, 85, 170}));
  EXPECT_EQ(seen.near_depth, 0);
  EXPECT_EQ(seen.far_depth, 0.25);
}

TEST(Viewport, WithoutBoundsIsAllOfTheDisplay) { EXPECT_EQ(project_all({}).rect, kDisplay); }

TEST(Viewport, VerticesThatAreNotFiniteCountForNothing) {
  const std::vector<glm::dvec3> finite = {{-0.5, -0.25, 0}, {0.5, 0.5, 0.25}};
  const geometry::Rect expected = project_all(finite).rect;
  for (const double odd : {kNan, kInfinity, -kInfinity}) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<glm::dvec3> bounds = finite;
      bounds.insert(bounds.begin(), glm::dvec3(0.25));
      bounds.front()[axis] = odd;
      const Projected seen = project_all(bounds);
      EXPECT_EQ(seen.rect, expected) << odd << " of axis " << axis;
      EXPECT_EQ(seen.near_depth, -1);  // as of a vertex behind the near plane
      EXPECT_EQ(seen.far_depth, 0.25);
      EXPECT_FALSE(is_in(project_all({bounds.front()}).rect, kDisplay));
    }
  }
}

// The corners of a display that is as large as can be.
TEST(Viewport, FarDisplays) {
  constexpr int kFar = (1 << 30) - 1;
  const geometry::Rect display{-kFar, -kFar, kFar, kFar};
  const Projected seen =
      project(std::vector<glm::dvec3>{{-1, -1, 0}, {1, 1, 0}}, glm::dmat4(1), display);
  EXPECT_EQ(seen.rect, display);
}

}  // namespace delray::icet
