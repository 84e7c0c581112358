// The graph partition follows lines that little crosses.
#include <gtest/gtest.h>

#include <algorithm>

#include "loadbalance/balance.h"
#include "loadbalance/partition.h"
#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Partition graph(const Costs& costs, int parts) {
  return find_partitioner("graph")->partition(costs, costs.frame, parts);
}

// Two boxes beside each other and a third below the first make an L that nothing crosses; any
// rectangle of half the cost would cut through a box.
TEST(Graph, FindsARegionThatIsNotARectangle) {
  const std::vector<WeightedBox> boxes = {{{0, 0, 8, 4}, 32, 8},
                                          {{0, 4, 4, 8}, 16, 4},  // the L, of 48
                                          {{8, 0, 12, 8}, 32, 8},
                                          {{4, 4, 8, 8}, 16, 4}};  // the rest
  const Costs costs = make_costs({0, 0, 12, 8}, 12, 8, boxes);
  const Partition partition = graph(costs, 2);
  const Balance result = balance(partition, boxes, 2);
  EXPECT_EQ(result.shared, 0U);
  EXPECT_EQ(result.loads, (std::vector<double>{48, 48}));
  const Balance rectangles =
      balance(find_partitioner("mahd")->partition(costs, costs.frame, 2), boxes, 2);
  EXPECT_GT(rectangles.shared, 0U);
}

TEST(Graph, SharesCostEvenly) {
  const Rect frame{0, 0, 640, 360};
  for (const testing::Scenery scenery :
       {testing::Scenery::uniform, testing::Scenery::heavy_tailed, testing::Scenery::horizon}) {
    const auto boxes = testing::boxes(scenery, frame, 5000, 3);
    const Costs costs = testing::costs_of(frame, 8, boxes);
    for (const int parts : {2, 3, 8}) {
      EXPECT_LE(imbalance(loads(costs, graph(costs, parts), parts)), 1.15)
          << static_cast<int>(scenery) << ' ' << parts;
    }
  }
}

// What it is for: fewer primitives in several regions than rectangles have.
TEST(Graph, SharesFewerPrimitivesThanRectanglesDo) {
  const Rect frame{0, 0, 640, 360};
  double regions = 0, rectangles = 0;
  for (const testing::Scenery scenery : testing::kSceneries) {
    const auto boxes = testing::boxes(scenery, frame, 5000, 3);
    const Costs costs = testing::costs_of(frame, 8, boxes);
    regions += report(*find_partitioner("graph"), costs, 8).balance.overlap - 1;
    rectangles += report(*find_partitioner("mahd"), costs, 8).balance.overlap - 1;
  }
  EXPECT_LT(regions, 0.85 * rectangles);
}

TEST(Graph, SharesCellsWhereThereIsNoCost) {
  const Costs costs = make_costs({0, 0, 64, 32}, 16, 8, {});
  std::vector<std::int64_t> area(4);
  for (const Region& region : graph(costs, 4).regions) area[region.owner] += region.rect.area();
  for (const std::int64_t pixels : area) EXPECT_EQ(pixels, 64 * 32 / 4);
}

TEST(Graph, MorePartsThanCellsLeavesSomeWithout) {
  const Partition partition = graph(make_costs({0, 0, 10, 10}, 2, 2, {}), 9);
  EXPECT_EQ(partition.regions.size(), 4U);
}

}  // namespace
}  // namespace delray::loadbalance
