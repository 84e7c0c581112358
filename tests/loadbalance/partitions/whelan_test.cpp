// Median cut counts centroids, whatever the sizes.
#include <gtest/gtest.h>

#include <random>

#include "loadbalance/partition.h"
#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Partition whelan(const Costs& costs, int parts) {
  return find_partitioner("whelan")->partition(costs, costs.frame, parts);
}

std::vector<int> centroids(const Partition& partition, std::span<const WeightedBox> boxes) {
  std::vector<int> count(partition.regions.size());
  for (const WeightedBox& box : boxes) {
    for (std::size_t k = 0; k < count.size(); ++k) {
      const Rect visible = geometry::intersection(box.box, partition.frame);
      if (partition.regions[k].rect.contains(visible.x0 + visible.width() / 2,
                                             visible.y0 + visible.height() / 2)) {
        count[k] += static_cast<int>(box.primitives);
      }
    }
  }
  return count;
}

TEST(Whelan, CutsTheLongerSideAtTheMedianWhateverTheSizes) {
  const std::vector<WeightedBox> boxes = {{{10, 0, 12, 2}, 1},    {{14, 0, 16, 2}, 1},
                                          {{30, 0, 32, 2}, 1000}, {{40, 0, 80, 20}, 9000},
                                          {{90, 0, 92, 2}, 1},    {{94, 0, 96, 2}, 1}};
  const Partition partition = whelan(make_costs({0, 0, 100, 20}, 5, 1, boxes), 2);
  ASSERT_EQ(partition.regions.size(), 2U);
  EXPECT_EQ(centroids(partition, boxes), (std::vector<int>{3, 3}));
  EXPECT_EQ(partition.regions[0].rect.height(), 20);
}

TEST(Whelan, AGroupCountsAsItsPrimitives) {
  const std::vector<WeightedBox> boxes = {
      {{0, 0, 2, 2}, 1, 0, 6}, {{50, 0, 52, 2}, 1, 0, 3}, {{90, 0, 92, 2}, 1, 0, 3}};
  const Partition partition = whelan(make_costs({0, 0, 100, 20}, 5, 1, boxes), 2);
  EXPECT_EQ(centroids(partition, boxes), (std::vector<int>{6, 6}));
}

TEST(Whelan, GivesEveryPartMuchTheSameNumber) {
  const Rect frame{0, 0, 1920, 1080};
  for (const testing::Scenery scenery : testing::kSceneries) {
    auto boxes = testing::boxes(scenery, frame, 20000, 3);
    std::erase_if(boxes, [&](const WeightedBox& box) {
      return geometry::intersection(box.box, frame).empty();
    });
    for (const int parts : {2, 5, 8}) {
      const double share = static_cast<double>(boxes.size()) / parts;
      for (const int count : centroids(whelan(make_costs(frame, 1, 1, boxes), parts), boxes)) {
        EXPECT_NEAR(count / share, 1, 0.06) << parts;
      }
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
