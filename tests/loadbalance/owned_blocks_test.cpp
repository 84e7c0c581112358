// Every block belongs to one owner.
#include "loadbalance/owned_blocks.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::loadbalance {
namespace {

TEST(OwnedBlocks, AreThoseWhoseMiddleLiesInARegion) {
  // Of the second block of 4 pixels the border leaves half to each; its middle is the owner's of
  // what comes after.
  const Partition partition{{0, 0, 12, 8}, {{{0, 0, 6, 8}, 1}, {{6, 0, 12, 8}, 0}}};
  const Blocks blocks{{0, 0, 12, 8}, 4, 4};
  EXPECT_EQ(owned_blocks(partition, blocks, 0), (std::vector<TaskRange>{{1, 3}, {4, 6}}));
  EXPECT_EQ(owned_blocks(partition, blocks, 1), (std::vector<TaskRange>{{0, 1}, {3, 4}}));
  EXPECT_TRUE(owned_blocks(partition, blocks, 2).empty());
}

TEST(OwnedBlocks, GiveEveryBlockToOneOwner) {
  const geometry::Rect frame{3, -2, 103, 75};
  for (const Partitioner& partitioner : partitioners()) {
    const std::vector<WeightedBox> boxes = {{{3, -2, 40, 30}, 5, 0, 1},
                                            {{60, 20, 80, 75}, 9, 1, 1}};
    const Costs costs = make_costs(frame, 25, 19, boxes);
    for (const int side : {4, 7, 32}) {
      for (const int owners : {1, 3, 8}) {
        const Partition partition = partitioner.partition(costs, frame, owners);
        const Blocks blocks{frame, side, side};
        std::vector<int> times(blocks.grid().count());
        for (int owner = 0; owner < owners; ++owner) {
          for (const TaskRange& range : owned_blocks(partition, blocks, owner))
            for (std::uint32_t block = range.first; block < range.last; ++block) ++times[block];
        }
        for (const int n : times) ASSERT_EQ(n, 1) << partitioner.name << ' ' << side;
      }
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
