// Roble's splits and mergers.
#include <gtest/gtest.h>

#include <algorithm>

#include "loadbalance/partition.h"
#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Partition roble(const Costs& costs, int parts) {
  return find_partitioner("roble")->partition(costs, costs.frame, parts);
}

int count(const Region& region, std::span<const WeightedBox> boxes) {
  return static_cast<int>(std::count_if(boxes.begin(), boxes.end(), [&](const WeightedBox& box) {
    return !geometry::intersection(box.box, region.rect).empty();
  }));
}

int largest(const Partition& partition, std::span<const WeightedBox> boxes) {
  int result = 0;
  for (const Region& region : partition.regions) result = std::max(result, count(region, boxes));
  return result;
}

TEST(Roble, KeepsTheGridWhereNothingIsUneven) {
  std::vector<WeightedBox> boxes;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) boxes.push_back({{x, y, x + 1, y + 1}, 1});
  }
  const Partition partition = roble(make_costs({0, 0, 60, 40}, 1, 1, boxes), 6);
  ASSERT_EQ(partition.regions.size(), 6U);
  for (const Region& region : partition.regions) EXPECT_EQ(region.rect.area(), 400);
}

// All in one of four quarters: it is halved, and two of the empty ones become one.
TEST(Roble, HalvesTheFullAndMergesTheEmpty) {
  std::vector<WeightedBox> boxes;
  for (int x = 0; x < 20; ++x) boxes.push_back({{x, 0, x + 1, 20}, 1});
  const Partition partition = roble(make_costs({0, 0, 40, 40}, 1, 1, boxes), 4);
  ASSERT_EQ(partition.regions.size(), 4U);
  EXPECT_LE(largest(partition, boxes), 10);
}

TEST(Roble, IsNeverWorseThanTheGridItStartsFrom) {
  const Rect frame{0, 0, 1080, 1080};
  for (const testing::Scenery scenery : testing::kSceneries) {
    const auto boxes = testing::boxes(scenery, frame, 3000, 5);
    Partition grid{frame, {}};
    for (int k = 0; k < 16; ++k) {
      grid.regions.push_back({{k % 4 * 270, k / 4 * 270, k % 4 * 270 + 270, k / 4 * 270 + 270}, k});
    }
    const Partition partition = roble(make_costs(frame, 1, 1, boxes), 16);
    EXPECT_EQ(partition.regions.size(), 16U);
    EXPECT_LE(largest(partition, boxes), largest(grid, boxes)) << static_cast<int>(scenery);
  }
  const auto boxes = testing::boxes(testing::Scenery::clusters, frame, 3000, 5);
  EXPECT_LE(largest(roble(make_costs(frame, 1, 1, boxes), 16), boxes), 3000 / 4);
}

}  // namespace
}  // namespace delray::loadbalance
