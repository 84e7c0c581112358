// The largest goes to the least loaded.
#include "loadbalance/partitions/largest_first.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "loadbalance/partition.h"
#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

TEST(LargestFirst, GivesTheLargestToTheLeastLoaded) {
  EXPECT_EQ(internal::largest_first(std::vector<double>{3, 7, 4, 5, 3}, 2),
            (std::vector<int>{0, 0, 1, 1, 1}));
  EXPECT_EQ(internal::largest_first(std::vector<double>{1, 1, 1}, 5), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(internal::largest_first({}, 3).empty());
}

// Graham's bound: at most 4/3 of the best, which is no less than the mean or the largest item.
TEST(LargestFirst, EvensOutEveryPartition) {
  const geometry::Rect frame{0, 0, 640, 360};
  for (const testing::Scenery scenery : testing::kSceneries) {
    const auto boxes = testing::boxes(scenery, frame, 1500, 9);
    const Costs costs = testing::costs_of(frame, 8, boxes);
    for (const Partitioner& partitioner : partitioners()) {
      for (const int ranks : {1, 3, 8}) {
        const Partition regions = partitioner.partition(costs, frame, 8 * ranks);
        const Partition partition = assign_largest_first(costs, regions, ranks);
        ASSERT_EQ(partition.regions.size(), regions.regions.size());
        const std::vector<double> before = loads(costs, regions, 8 * ranks);
        const std::vector<double> after = loads(costs, partition, ranks);
        double total = 0;
        for (const double load : before) total += load;
        const double bound =
            std::max(total / ranks, *std::max_element(before.begin(), before.end()));
        EXPECT_LE(*std::max_element(after.begin(), after.end()), bound * 4 / 3 + 1e-9)
            << partitioner.name;
        const Partition at_once = partition_for_ranks(partitioner, costs, ranks, 8);
        EXPECT_EQ(loads(costs, at_once, ranks), after);
      }
    }
  }
}

TEST(LargestFirst, KeepsRegionsOfOneOwnerTogether) {
  Costs costs = make_costs({0, 0, 6, 1}, 6, 1, {});
  costs.cells = {5, 1, 4, 1, 3, 1};
  const Partition regions{costs.frame,
                          {{{0, 0, 1, 1}, 0},
                           {{1, 0, 2, 1}, 1},
                           {{2, 0, 3, 1}, 2},
                           {{3, 0, 4, 1}, 1},
                           {{4, 0, 5, 1}, 3},
                           {{5, 0, 6, 1}, 1}}};
  const Partition partition = assign_largest_first(costs, regions, 2);
  // 5 | 4, then one of the two of 3, to the rank with 4, then the other.
  EXPECT_EQ(loads(costs, partition, 2), (std::vector<double>{8, 7}));
  EXPECT_EQ(partition.regions[1].owner, partition.regions[3].owner);
  EXPECT_EQ(partition.regions[1].owner, partition.regions[5].owner);
}

}  // namespace
}  // namespace delray::loadbalance
