#include "loadbalance/kept_partition.h"

#include <gtest/gtest.h>

#include "loadbalance/cost_model.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Costs costs_over(const Rect& frame, std::vector<double> cells) {
  Costs costs = make_costs(frame, static_cast<int>(cells.size()), 1, {});
  costs.cells = std::move(cells);
  return costs;
}

TEST(KeptPartition, IsCutAnewOnlyWhenSomebodyDoesTooMuch) {
  const Rect frame{0, 0, 4, 1};
  KeptPartition kept(*find_partitioner("mahd"), 2, 1.5);
  const auto border = [&](std::vector<double> cells) {
    return kept.next(costs_over(frame, std::move(cells))).regions[0].rect.x1;
  };
  EXPECT_EQ(border({1, 1, 1, 1}), 2);
  EXPECT_EQ(border({2, 1, 1, 0}), 2);  // 3 of 4 are 1.5 times 2
  EXPECT_EQ(border({0, 0, 0, 0}), 2);
  EXPECT_EQ(kept.recomputed(), 1U);
  EXPECT_EQ(border({4, 1, 1, 0.5}), 1);
  EXPECT_EQ(kept.recomputed(), 2U);
  EXPECT_EQ(border({2, 1, 1, 0}), 1);
  EXPECT_EQ(kept.recomputed(), 2U);
  EXPECT_EQ(kept.frames(), 5U);
}

// The model takes both halves for equal; the first frame shows that the left one takes thrice as
// long.
TEST(KeptPartition, FollowsMeasurements) {
  const Rect frame{0, 0, 8, 1};
  KeptPartition kept(*find_partitioner("mahd"), 2, 1.25);
  EXPECT_TRUE(kept.last().regions.empty());
  Costs costs = costs_over(frame, {1, 1, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(kept.next(costs).regions[0].rect.x1, 4);
  scale_to_measured(costs, kept.last(), std::vector<double>{3, 1});
  EXPECT_EQ(kept.next(costs).regions[0].rect.x1, 3);  // 2.25 of 4
  EXPECT_EQ(kept.last().regions[0].rect.x1, 3);
  EXPECT_EQ(kept.recomputed(), 2U);
}

TEST(KeptPartition, FollowsTheFrame) {
  KeptPartition kept(*find_partitioner("mahd"), 2, 10);
  kept.next(costs_over({0, 0, 4, 1}, {1, 1, 1, 1}));
  EXPECT_EQ(kept.next(costs_over({0, 0, 8, 1}, {1, 1, 1, 1})).frame, (Rect{0, 0, 8, 1}));
  EXPECT_EQ(kept.recomputed(), 2U);
}

TEST(KeptPartition, AssignsMoreRegionsThanRanks) {
  KeptPartition kept(*find_partitioner("mahd"), 2, 1, 2);
  const Partition& partition = kept.next(costs_over({0, 0, 4, 1}, {4, 1, 2, 3}));
  EXPECT_EQ(partition.regions.size(), 4U);
  EXPECT_EQ(loads(costs_over({0, 0, 4, 1}, {4, 1, 2, 3}), partition, 2),
            (std::vector<double>{5, 5}));
}

}  // namespace
}  // namespace delray::loadbalance
