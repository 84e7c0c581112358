// Balance against counting pixel by pixel.
#include "loadbalance/balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

TEST(Balance, CountsASetupForEachOwnerAndTheRestByArea) {
  const Partition partition{{0, 0, 20, 10},
                            {{{0, 0, 10, 10}, 0}, {{10, 0, 20, 5}, 1}, {{10, 5, 20, 10}, 0}}};
  const WeightedBox boxes[] = {{{8, 0, 12, 2}, 10, 2, 3},    // half each in 0 and 1
                               {{-2, 4, 18, 6}, 20, 4},      // 28 of 36 pixels in 0
                               {{0, 0, 2, 2}, 1},            // in 0
                               {{10, 8, 12, 10}, 2, 2},      // in 0
                               {{30, 0, 40, 10}, 100, 50}};  // nowhere
  const Balance result = balance(partition, boxes, 3);
  ASSERT_EQ(result.loads.size(), 3U);
  EXPECT_DOUBLE_EQ(result.loads[0], 2 + 4 + 4 + 16.0 * 28 / 36 + 1 + 2);
  EXPECT_DOUBLE_EQ(result.loads[1], 2 + 4 + 4 + 16.0 * 8 / 36);
  EXPECT_EQ(result.loads[2], 0);
  EXPECT_DOUBLE_EQ(result.alone, 33);
  EXPECT_EQ(result.primitives, 6U);
  EXPECT_EQ(result.shared, 4U);
  EXPECT_DOUBLE_EQ(result.overlap, (3 * 2 + 1 * 2 + 1 + 1) / 6.0);
  EXPECT_DOUBLE_EQ(result.over_share, result.loads[0] * 3 / 33);
  EXPECT_DOUBLE_EQ(result.imbalance, result.loads[0] * 3 / (result.loads[0] + result.loads[1]));
}

TEST(Balance, OfNothing) {
  const Partition partition{{0, 0, 4, 4}, {{{0, 0, 4, 4}, 1}}};
  const Balance result = balance(partition, {}, 2);
  EXPECT_EQ(result.loads, (std::vector<double>{0, 0}));
  EXPECT_EQ(result.over_share, 1);
  EXPECT_EQ(result.imbalance, 1);
  EXPECT_EQ(result.overlap, 1);
}

TEST(Balance, AgreesWithPixelByPixelForEveryPartition) {
  const Rect frame{-7, 5, 60, 44};
  for (const Partitioner& partitioner : partitioners()) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(std::string(partitioner.name) + ", seed " + std::to_string(seed));
      const auto boxes = testing::boxes(testing::kSceneries[seed], frame, 60, seed);
      const int parts = 3 + 4 * static_cast<int>(seed);
      const Partition partition =
          partitioner.partition(testing::costs_of(frame, 4, boxes), frame, parts);
      std::vector<int> owner_of(static_cast<std::size_t>(frame.area()));
      const auto at = [&](int x, int y) {
        return static_cast<std::size_t>((y - frame.y0) * frame.width() + x - frame.x0);
      };
      for (const Region& region : partition.regions) {
        for (int y = region.rect.y0; y < region.rect.y1; ++y) {
          for (int x = region.rect.x0; x < region.rect.x1; ++x) owner_of[at(x, y)] = region.owner;
        }
      }
      std::vector<double> expected(static_cast<std::size_t>(parts));
      double overlap = 0, count = 0;
      for (const WeightedBox& box : boxes) {
        const Rect visible = geometry::intersection(box.box, frame);
        if (visible.empty()) continue;
        std::set<int> owners;
        for (int y = visible.y0; y < visible.y1; ++y) {
          for (int x = visible.x0; x < visible.x1; ++x) {
            owners.insert(owner_of[at(x, y)]);
            expected[owner_of[at(x, y)]] +=
                (box.cost - box.setup) / static_cast<double>(visible.area());
          }
        }
        for (const int owner : owners) expected[owner] += box.setup;
        overlap += static_cast<double>(owners.size());
        ++count;
      }
      const Balance result = balance(partition, boxes, parts);
      for (int k = 0; k < parts; ++k) EXPECT_NEAR(result.loads[k], expected[k], 1e-9);
      EXPECT_NEAR(result.overlap, overlap / count, 1e-9);
    }
  }
}

// The promise for scenes: nobody does more than 1.35 of its share, duplicated work included.
TEST(Balance, OfMahdAndKdSplitIsWithin135Percent) {
  const Rect frame{0, 0, 1920, 1080};
  for (const testing::Scenery scenery : testing::kSceneries) {
    const auto boxes = testing::boxes(scenery, frame, 40000, 7);
    for (const int parts : {16, 64}) {
      const Costs costs = testing::costs_of(frame, cost_cell_side(frame, parts), boxes);
      for (const char* name : {"mahd", "kd-split"}) {
        const Partition partition = find_partitioner(name)->partition(costs, frame, parts);
        EXPECT_LE(balance(partition, boxes, parts).over_share, 1.35)
            << name << ", " << parts << " parts, scenery " << static_cast<int>(scenery);
      }
    }
  }
}

TEST(PartitionReport, SaysWhatItsPartsSay) {
  const Rect frame{0, 0, 320, 200};
  const auto boxes = testing::boxes(testing::Scenery::horizon, frame, 500, 2);
  const Costs costs = testing::costs_of(frame, 8, boxes);
  for (const Partitioner& partitioner : partitioners()) {
    const PartitionReport result = report(partitioner, costs, 4, 3);
    const std::vector<double> predicted = loads(costs, result.partition, 4);
    EXPECT_EQ(result.predicted, imbalance(predicted));
    EXPECT_EQ(result.balance.loads, balance(result.partition, boxes, 4).loads);
    EXPECT_GT(result.balance.overlap, 1);
    EXPECT_GE(result.seconds, 0);
    for (const Region& region : result.partition.regions) EXPECT_LT(region.owner, 4);
  }
}

TEST(Imbalance, IsTheLargestOverTheMean) {
  EXPECT_EQ(imbalance(std::vector<double>{1, 2, 3}), 1.5);
  EXPECT_EQ(imbalance(std::vector<double>{0, 0}), 1);
  EXPECT_EQ(imbalance(std::vector<double>{0, 4}), 2);
  EXPECT_EQ(imbalance({}), 1);
}

}  // namespace
}  // namespace delray::loadbalance
