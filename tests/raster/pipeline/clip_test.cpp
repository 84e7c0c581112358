#include "raster/pipeline/clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/raster/coverage.h"

namespace delray::raster {
namespace {

using Corners = std::array<glm::vec3, 3>;

ScreenPolygon clipped(const Screen& screen, const Corners& view) {
  ToView identity;
  for (int k = 0; k < 3; ++k) {
    identity.row[k] = glm::vec4(0.0F);
    identity.row[k][k] = 1;
  }
  const std::uint32_t which[] = {0, 1, 2};
  ScreenVertices vertices;
  transform(identity, screen, view, which, vertices);
  return clip(screen, view, {vertices[0], vertices[1], vertices[2]});
}

float random_coordinate(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  return std::ldexp(unit(random), static_cast<int>(random() % 100) - 30);
}

std::vector<std::array<double, 3>> corners_of(const ScreenPolygon& polygon) {
  std::vector<std::array<double, 3>> corners;
  for (int i = 0; i < polygon.size; ++i) {
    corners.push_back({static_cast<double>(polygon.vertex[i].x),
                       static_cast<double>(polygon.vertex[i].y), double{polygon.vertex[i].depth}});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

TEST(Clip, CutsAnEdgeAtTheSamePointWhicheverWayItRuns) {
  const Screen screen = make_screen(plain_view(641, 480));
  std::mt19937 random(1);
  int cut = 0;
  for (int round = 0; round < 20000; ++round) {
    Corners view;
    for (glm::vec3& v : view)
      v = {random_coordinate(random), random_coordinate(random), random_coordinate(random)};
    const ScreenPolygon polygon = clipped(screen, view);
    const ScreenPolygon reversed = clipped(screen, {view[2], view[1], view[0]});
    ASSERT_EQ(corners_of(polygon), corners_of(reversed)) << "round " << round;
    cut += polygon.size > 0;
    for (int i = 0; i < polygon.size; ++i) {
      ASSERT_LE(std::abs(polygon.vertex[i].x), kGuardSubpixels);
      ASSERT_LE(std::abs(polygon.vertex[i].y), kGuardSubpixels);
      ASSERT_GE(polygon.vertex[i].depth, -1.0F);
      ASSERT_LT(polygon.vertex[i].depth, 0.0F);
    }
  }
  EXPECT_GT(cut, 2000);
}

TEST(Clip, KeepsWhatIsInFrontOfTheNearPlane) {
  const Screen screen = make_screen(plain_view(100, 100));
  const float near = screen.view.near;
  // One corner behind: a quadrilateral, two of whose corners are on the near plane.
  const ScreenPolygon four = clipped(screen, {glm::vec3(-1, 0, 4), {1, 0, 4}, {0, 0.001F, -1}});
  EXPECT_EQ(four.size, 4);
  int on_plane = 0;
  for (int i = 0; i < four.size; ++i) on_plane += four.vertex[i].depth == -1.0F;
  EXPECT_EQ(on_plane, 2);
  // Two behind: a triangle. The corner in front stays where transform put it.
  const ScreenPolygon three = clipped(screen, {glm::vec3(0, 0, 4), {1, 0, -4}, {-1, 0.001F, -1}});
  EXPECT_EQ(three.size, 3);
  EXPECT_EQ(three.vertex[0].x, 0);
  EXPECT_EQ(three.vertex[0].depth, -near / 4);
  EXPECT_EQ(clipped(screen, {glm::vec3(0, 0, -4), {1, 0, -4}, {0, 1, 0}}).size, 0);
}

TEST(Clip, DropsWhatIsNotFinite) {
  const Screen screen = make_screen(plain_view(100, 100));
  for (const float bad : {std::numeric_limits<float>::infinity(), std::nanf("")}) {
    for (int k = 0; k < 3; ++k) {
      Corners view{glm::vec3(0, 0, 1), {1, 0, 1}, {0, 1, 1}};
      view[1][k] = bad;
      EXPECT_EQ(clipped(screen, view).size, 0);
    }
  }
}

}  // namespace
}  // namespace delray::raster
