// Vertices are matched to the lowest equal row, also through floats.
#include "delaunay/match_points.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::delaunay {
namespace {

using SpacePoints = std::vector<glm::dvec3>;

TEST(MatchPoints, FindsTheLowestRow) {
  const SpacePoints points = {{1, 2, 3}, {0, 0, 0}, {1, 2, 4}, {5, 5, 5}};
  const SpacePoints vertices = {{-0.0, 0, 9}, {1, 2, 4}};
  const PointMatch match = match_points(view(vertices), view(points), {.dim = 2});
  EXPECT_FALSE(match.unknown || match.ambiguous);
  EXPECT_EQ(match.rows, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(match.distinct, 3U);
  EXPECT_EQ(match.unused, 1U);
  EXPECT_EQ(match_points(view(vertices), view(points), {.dim = 3}).unknown, 0U);
}

TEST(MatchPoints, RoundsToFloats) {
  const SpacePoints points = {{0.1, 0.2, 0.3}, {1e300, 0, 0}, {0.1 + 1e-12, 0.2, 7}, {4, 4, 4}};
  const auto rounded = [](const glm::dvec3& p) { return glm::dvec3(glm::vec3(p)); };
  const SpacePoints one = {rounded(points[3])}, two = {rounded(points[3]), rounded(points[0])};
  EXPECT_EQ(match_points(view(two), view(points), {.dim = 2}).unknown, 1U);
  const PointMatch good = match_points(view(one), view(points), {.dim = 2, .as_floats = true});
  EXPECT_FALSE(good.unknown || good.ambiguous);
  EXPECT_EQ(good.unused, 3U);
  const PointMatch bad = match_points(view(two), view(points), {.dim = 2, .as_floats = true});
  ASSERT_TRUE(bad.ambiguous);
  EXPECT_EQ(bad.ambiguous->vertex, 1U);
  EXPECT_EQ(bad.ambiguous->rows, (std::array<std::size_t, 2>{0, 2}));
  const PointMatch by_height =
      match_points(view(two), view(points), {.dim = 2, .as_floats = true, .with_z = true});
  EXPECT_FALSE(by_height.unknown || by_height.ambiguous);
  EXPECT_EQ(by_height.rows, (std::vector<std::uint32_t>{3, 0}));
}

}  // namespace
}  // namespace delray::delaunay
