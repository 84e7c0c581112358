// Partitions are kept until a rank does too much.
#include "loadbalance/kept_partition.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <utility>

#include "comm/threads.h"
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

std::atomic<int> cuts;

Partition counted_mahd(const Costs& costs, Rect frame, int parts) {
  ++cuts;
  return find_partitioner("mahd")->partition(costs, frame, parts);
}

TEST(KeptPartition, IsTheSameOnAllRanksAndCutOnOne) {
  constexpr int kRanks = 5, kFrames = 8;
  constexpr Partitioner kCounted{"counted", "", counted_mahd, ""};
  std::vector<Costs> frames;
  for (unsigned seed = 0; seed < kFrames; ++seed) {
    std::mt19937 random(seed / 2);  // every other frame is like the last
    std::vector<double> cells(40);
    for (double& cost : cells) cost = std::uniform_real_distribution<double>(0, 1)(random);
    frames.push_back(costs_over({0, 0, 40, 2}, std::move(cells)));
  }
  KeptPartition alone(*find_partitioner("mahd"), kRanks, 1.3, 2);
  std::vector<Partition> expected;
  for (const Costs& costs : frames) expected.push_back(alone.next(costs));
  cuts = 0;
  comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
    KeptPartition kept(kCounted, kRanks, 1.3, 2);
    for (int frame = 0; frame < kFrames; ++frame) {
      const Partition& partition =
          kept.next(communicator.rank() == 0 ? frames[frame] : Costs(), communicator);
      EXPECT_EQ(partition.frame, expected[frame].frame);
      ASSERT_EQ(partition.regions.size(), expected[frame].regions.size());
      for (std::size_t k = 0; k < partition.regions.size(); ++k) {
        EXPECT_EQ(partition.regions[k].rect, expected[frame].regions[k].rect);
        EXPECT_EQ(partition.regions[k].owner, expected[frame].regions[k].owner);
      }
    }
    EXPECT_EQ(kept.recomputed(), alone.recomputed());
    EXPECT_EQ(kept.frames(), alone.frames());
  });
  EXPECT_EQ(static_cast<std::uint64_t>(cuts), alone.recomputed());
  EXPECT_GT(cuts, 1);
  EXPECT_LT(cuts, kFrames);
}

}  // namespace
}  // namespace delray::loadbalance
