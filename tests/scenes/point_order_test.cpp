// Points along a curve: neighbours are near, and equal ones keep their order.
#include "scenes/point_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace delray::scenes {
namespace {

TEST(PointOrder, BringsNeighboursTogetherAndKeepsEqualOnes) {
  std::mt19937 random(20261130);
  std::uniform_real_distribution<float> both(-3, 5);
  std::vector<glm::vec3> points;
  geometry::Box3 box;
  for (int i = 0; i < 20000; ++i) {
    points.emplace_back(both(random), both(random), both(random));
    if (i % 5 == 0) points.back() = {1, 2, 3};
    box.include(points.back());
  }
  const PointOrder order(box);
  const std::vector<PointPlace> sorted = order_points(points, order);
  ASSERT_EQ(sorted.size(), points.size());
  EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end()));
  std::vector<bool> seen(points.size());
  double length = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    EXPECT_FALSE(seen[sorted[i].point]);
    seen[sorted[i].point] = true;
    EXPECT_EQ(sorted[i].place, order.place(points[sorted[i].point]));
    if (i > 0) length += glm::distance(points[sorted[i].point], points[sorted[i - 1].point]);
  }
  // 16 000 places in a cube of 512: about 0.32 to a neighbour.
  EXPECT_LT(length / 16000, 0.6);
}

TEST(PointOrder, OfOnePlaceIsThatOfTheInput) {
  for (const std::size_t n : {0U, 1U, 5000U}) {
    const std::vector<glm::vec3> points(n, {1, 1, 1});
    geometry::Box3 box;
    for (const glm::vec3& p : points) box.include(p);
    const std::vector<PointPlace> sorted = order_points(points, PointOrder(box));
    ASSERT_EQ(sorted.size(), n);
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(sorted[i].point, i);
  }
}

TEST(PointOrder, RunsAreAboutEqual) {
  std::vector<std::uint64_t> sorted;
  for (std::uint64_t i = 0; i < 1000; ++i) sorted.push_back(3 * i);
  const std::vector<std::uint64_t> begins = equal_runs(sorted, 4);
  EXPECT_EQ(begins, (std::vector<std::uint64_t>{750, 1500, 2250}));
  EXPECT_TRUE(equal_runs(std::vector<std::uint64_t>(1000, 7), 4).empty());
  EXPECT_TRUE(equal_runs({}, 4).empty());
}

}  // namespace
}  // namespace delray::scenes
