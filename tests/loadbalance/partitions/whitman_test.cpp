// Whitman's quadtree: ten leaves a part, divided where the primitives are.
#include <gtest/gtest.h>

#include <algorithm>

#include "loadbalance/partition.h"
#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Partition whitman(const Costs& costs, int parts) {
  return find_partitioner("whitman")->partition(costs, costs.frame, parts);
}

TEST(Whitman, MakesAboutTenRegionsForEachPart) {
  const Rect frame{0, 0, 512, 512};
  for (const testing::Scenery scenery : testing::kSceneries) {
    const auto boxes = testing::boxes(scenery, frame, 2000, 11);
    for (const int parts : {1, 3, 16}) {
      const auto regions = whitman(testing::costs_of(frame, 4, boxes), parts).regions;
      EXPECT_GE(regions.size(), 10U * parts);
      EXPECT_LE(regions.size(), 10U * parts + 2);
    }
  }
}

// Primitives in one corner of 16 x 16 cells: the nodes above it are divided, no others.
TEST(Whitman, DividesWhereThePrimitivesAre) {
  std::vector<WeightedBox> boxes(100, WeightedBox{{0, 0, 2, 2}, 1});
  const auto regions = whitman(make_costs({0, 0, 32, 32}, 16, 16, boxes), 1).regions;
  ASSERT_EQ(regions.size(), 10U);
  int cells = 0;
  for (const Region& region : regions) {
    if (region.rect.area() == 4) ++cells;
  }
  EXPECT_EQ(cells, 0);  // a tenth region comes one division earlier
  EXPECT_EQ(std::count_if(regions.begin(), regions.end(),
                          [](const Region& r) {
                            return r.rect == Rect{0, 0, 4, 4};
                          }),
            1);
}

// A primitive over four cells counts four times, so its owner gets nothing of the rest.
TEST(Whitman, CountsLargePrimitivesInEveryCell) {
  const std::vector<WeightedBox> boxes = {{{0, 0, 2, 2}, 1},
                                          {{2, 0, 3, 1}, 1},
                                          {{3, 0, 4, 1}, 1},
                                          {{2, 1, 3, 2}, 1},
                                          {{3, 1, 4, 2}, 1}};
  const Partition partition = whitman(make_costs({0, 0, 4, 2}, 4, 2, boxes), 2);
  double left[2] = {0, 0}, right[2] = {0, 0};
  for (const Region& region : partition.regions) {
    (region.rect.x0 < 2 ? left : right)[region.owner] += static_cast<double>(region.rect.area());
  }
  EXPECT_EQ(left[0] + right[0], 4);
  EXPECT_EQ(left[1] + right[1], 4);
}

}  // namespace
}  // namespace delray::loadbalance
