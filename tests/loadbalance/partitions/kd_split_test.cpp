// Sweep lines cut where the curves of cost cross.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "loadbalance/balance.h"
#include "loadbalance/partition.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

Partition kd_split(const Costs& costs, int parts) {
  return find_partitioner("kd-split")->partition(costs, costs.frame, parts);
}

// Six boxes that cost as much wherever they are cut: the curves over x = 0, 1, ... are
// left 0 1 1 2 3 3 4 4 5 6 6 ... and right 6 6 5 5 4 3 3 2 2 1 1 ...; they cross at 5.
TEST(KdSplit, CutsWhereTheCurvesCross) {
  std::vector<WeightedBox> boxes;
  const int begins[] = {0, 2, 3, 5, 7, 8}, ends[] = {2, 5, 4, 7, 9, 20};
  for (int k = 0; k < 6; ++k) boxes.push_back({{begins[k], 0, ends[k], 4}, 1, 1});
  const Costs costs = make_costs({0, 0, 20, 4}, 5, 1, boxes);
  const Partition partition = kd_split(costs, 2);
  ASSERT_EQ(partition.regions.size(), 2U);
  EXPECT_EQ(partition.regions[0].rect, (Rect{0, 0, 5, 4}));
  EXPECT_EQ(balance(partition, boxes, 2).loads, (std::vector<double>{3, 3}));
}

TEST(KdSplit, CutsThroughAreaWherePixelsCost) {
  const std::vector<WeightedBox> boxes = {{{0, 0, 100, 10}, 1000}, {{80, 0, 100, 10}, 600}};
  const Costs costs = make_costs({0, 0, 100, 10}, 1, 1, boxes);  // cells do not matter
  const Partition partition = kd_split(costs, 2);
  EXPECT_EQ(partition.regions[0].rect, (Rect{0, 0, 80, 10}));
  EXPECT_EQ(balance(partition, boxes, 2).loads, (std::vector<double>{800, 800}));
}

TEST(KdSplit, NoOtherCutOfTheLongerSideIsBetter) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return std::uniform_int_distribution<int>(low, high)(random);
    };
    const Rect frame{-3, 2, -3 + number(20, 40), 2 + number(3, 20)};
    std::vector<WeightedBox> boxes;
    for (int k = number(1, 30); k > 0; --k) {
      const int x = number(-10, 40), y = number(0, 20), cost = number(1, 9);
      boxes.push_back({{x, y, x + number(1, 12), y + number(1, 5)},
                       static_cast<double>(cost),
                       static_cast<double>(number(0, cost))});
    }
    const Costs costs = make_costs(frame, 4, 4, boxes);
    const auto worst = [&](const Partition& partition) {
      const auto loads = balance(partition, boxes, 2).loads;
      return std::max(loads[0], loads[1]);
    };
    double best = 1e30;
    for (int x = frame.x0 + 1; x < frame.x1; ++x) {
      best = std::min(best, worst({frame,
                                   {{{frame.x0, frame.y0, x, frame.y1}, 0},
                                    {{x, frame.y0, frame.x1, frame.y1}, 1}}}));
    }
    EXPECT_LE(worst(kd_split(costs, 2)), best + 1e-9) << "seed " << seed;
  }
}

TEST(KdSplit, TakesCellsWithoutBoxes) {
  Costs costs = make_costs({0, 0, 80, 1}, 8, 1, {});
  costs.cells = {0, 0, 0, 0, 0, 0, 3, 1};
  const Partition partition = kd_split(costs, 2);
  const std::vector<double> expected{2.1, 1.9};  // a cell cut at one of its ten columns
  ASSERT_EQ(partition.regions.size(), 2U);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(loads(costs, partition, 2)[k], expected[k], 1e-12);
}

TEST(KdSplit, WithoutCostCutsByArea) {
  for (const Region& region : kd_split(make_costs({0, 0, 64, 64}, 4, 4, {}), 16).regions) {
    EXPECT_EQ(region.rect.area(), 256);
  }
}

}  // namespace
}  // namespace delray::loadbalance
