// Hybrid partitions: coverage, even work, and borders where fewest pixels are misplaced.
#include "loadbalance/hybrid_partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

std::vector<double> costs_of_owners(const HybridPartition& partition,
                                    std::span<const WeightedBox> boxes, int ranks) {
  std::vector<double> costs(static_cast<std::size_t>(ranks));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (partition.owners[i] >= 0) {
      costs[partition.owners[i]] += boxes[i].cost;
    } else if (partition.owners[i] == kEverybody) {
      const Rect visible = geometry::intersection(boxes[i].box, partition.regions.frame);
      for (const Region& region : partition.regions.regions) {
        costs[region.owner] +=
            boxes[i].cost *
            static_cast<double>(geometry::intersection(visible, region.rect).area()) /
            static_cast<double>(visible.area());
      }
    }
  }
  return costs;
}

// Pixels that owners cover outside their regions, each once per owner.
std::int64_t pixels_sent(const HybridPartition& partition, std::span<const WeightedBox> boxes,
                         int ranks) {
  const Rect& frame = partition.regions.frame;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y - frame.y0) * frame.width() + (x - frame.x0);
  };
  std::vector<int> owner_of(static_cast<std::size_t>(frame.area()), kNobody);
  for (const Region& region : partition.regions.regions) {
    for (int y = region.rect.y0; y < region.rect.y1; ++y)
      for (int x = region.rect.x0; x < region.rect.x1; ++x) owner_of[at(x, y)] = region.owner;
  }
  std::int64_t sent = 0;
  std::vector<bool> covered;
  for (int rank = 0; rank < ranks; ++rank) {
    covered.assign(owner_of.size(), false);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (partition.owners[i] != rank) continue;
      const Rect box = geometry::intersection(boxes[i].box, frame);
      for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
          if (owner_of[at(x, y)] != rank && !covered[at(x, y)]) ++sent;
          covered[at(x, y)] = true;
        }
      }
    }
  }
  return sent;
}

void expect_valid(const HybridPartition& partition, std::span<const WeightedBox> boxes,
                  const Rect& frame, int ranks) {
  ASSERT_EQ(partition.owners.size(), boxes.size());
  double all = 0;
  for (const WeightedBox& box : boxes)
    if (!geometry::intersection(box.box, frame).empty()) all += box.cost;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (geometry::intersection(boxes[i].box, frame).empty()) {
      ASSERT_EQ(partition.owners[i], kNobody);
    } else if (ranks > 1 && boxes[i].cost * ranks > all / 2) {
      ASSERT_EQ(partition.owners[i], kEverybody);
    } else {
      ASSERT_GE(partition.owners[i], 0);
      ASSERT_LT(partition.owners[i], ranks);
    }
  }
  ASSERT_EQ(partition.regions.frame, frame);
  std::vector<int> times(static_cast<std::size_t>(frame.area())), regions(ranks);
  for (const Region& region : partition.regions.regions) {
    ASSERT_FALSE(region.rect.empty());
    ASSERT_EQ(geometry::intersection(region.rect, frame), region.rect);
    ASSERT_GE(region.owner, 0);
    ASSERT_LT(region.owner, ranks);
    ASSERT_EQ(++regions[region.owner], 1);
    for (int y = region.rect.y0; y < region.rect.y1; ++y) {
      for (int x = region.rect.x0; x < region.rect.x1; ++x)
        ++times[static_cast<std::size_t>(y - frame.y0) * frame.width() + (x - frame.x0)];
    }
  }
  for (const int n : times) ASSERT_EQ(n, 1);
}

TEST(HybridPartition, GivesEachBoxOneOwnerAndCoversTheFrameOnce) {
  for (unsigned seed = 0; seed < 128; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return std::uniform_int_distribution<int>(low, high)(random);
    };
    const int x = number(-20, 20), y = number(-20, 20);
    const Rect frame{x, y, x + number(1, 120), y + number(1, 90)};
    std::vector<WeightedBox> boxes = testing::boxes(testing::kSceneries[seed % 4], frame,
                                                    number(0, 1) * number(0, 300), random());
    for (WeightedBox& box : boxes) {
      if (number(0, 9) == 0) box.box = {};
      if (number(0, 9) == 0) box.box.x0 -= number(0, 500);
      if (number(0, 19) == 0) box.cost = 0;
    }
    const int ranks = static_cast<int>(seed) / 2 + 1;
    const double pixel_cost = 0.5 * number(0, 2);
    const HybridPartition partition = hybrid_partition(boxes, frame, ranks, {pixel_cost, 0.5});
    expect_valid(partition, boxes, frame, ranks);
    const HybridPartition again = hybrid_partition(boxes, frame, ranks, {pixel_cost, 0.5});
    EXPECT_EQ(partition.owners, again.owners);
    ASSERT_EQ(partition.regions.regions.size(), again.regions.regions.size());
    for (std::size_t k = 0; k < again.regions.regions.size(); ++k) {
      EXPECT_EQ(partition.regions.regions[k].rect, again.regions.regions[k].rect);
      EXPECT_EQ(partition.regions.regions[k].owner, again.regions.regions[k].owner);
    }
  }
}

TEST(HybridPartition, TakesTinyAndEmptyFramesAndNoBoxes) {
  const WeightedBox everywhere[] = {{{-9, -9, 99, 99}, 3}, {{-9, -9, 99, 99}, 0}};
  for (const Rect frame :
       {Rect{0, 0, 0, 0}, Rect{5, 5, 5, 90}, Rect{3, 4, 4, 5}, Rect{0, 0, 1, 9}}) {
    for (const int ranks : {1, 2, 7, 64}) {
      expect_valid(hybrid_partition({}, frame, ranks, {1, 0.5}), {}, frame, ranks);
      expect_valid(hybrid_partition(everywhere, frame, ranks, {1, 0.5}), everywhere, frame, ranks);
    }
  }
}

TEST(HybridPartition, WithoutBoxesCutsByArea) {
  const HybridPartition partition = hybrid_partition({}, {0, 0, 64, 64}, 16);
  EXPECT_EQ(partition.regions.regions.size(), 16U);
  for (const Region& region : partition.regions.regions) EXPECT_EQ(region.rect.area(), 256);
}

TEST(HybridPartition, SharesBoxesAtTheSamePlaceEvenly) {
  const std::vector<WeightedBox> boxes(70, {{100, 100, 400, 300}, 2});
  for (const int ranks : {1, 2, 5, 7, 10, 14, 35, 70}) {
    const HybridPartition partition = hybrid_partition(boxes, {0, 0, 500, 400}, ranks, {0, 0.5});
    EXPECT_EQ(std::count(partition.owners.begin(), partition.owners.end(), kEverybody),
              ranks <= 35 ? 0 : 70);
    for (const double cost : costs_of_owners(partition, boxes, ranks))
      EXPECT_NEAR(cost * ranks / 140, 1, 0.45) << ranks;
  }
}

// Worked by hand: the low line takes the first box, the high one the last, then each the next, and
// so the lines pass each other. In columns 8 to 11, in both halves, the low half's box has 2 pixels
// each, the high half's 4.
TEST(HybridPartition, CutsWhereFewestPixelsAreOnTheWrongSide) {
  const WeightedBox boxes[] = {
      {{0, 0, 4, 4}, 40}, {{2, 1, 12, 3}, 40}, {{8, 0, 18, 4}, 40}, {{16, 0, 20, 4}, 40}};
  const HybridPartition partition = hybrid_partition(boxes, {0, 0, 20, 4}, 2, {0, 1});
  EXPECT_EQ(partition.owners, (std::vector<int>{0, 0, 1, 1}));
  ASSERT_EQ(partition.regions.regions.size(), 2U);
  EXPECT_EQ(partition.regions.regions[0].rect, (Rect{0, 0, 8, 4}));
  EXPECT_EQ(partition.regions.regions[1].rect, (Rect{8, 0, 20, 4}));
  EXPECT_EQ(pixels_sent(partition, boxes, 2), 8);
}

TEST(HybridPartition, NoOtherBorderLeavesFewerPixelsOnTheWrongSide) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return std::uniform_int_distribution<int>(low, high)(random);
    };
    const Rect frame{-3, 2, -3 + number(20, 40), 3};  // a row: boxes overlap or do not
    std::vector<WeightedBox> boxes;
    for (int k = number(1, 12); k > 0; --k) {
      const int x = number(-5, 40), cost = number(12, 21);  // more than pixels
      boxes.push_back({{x, 0, x + number(1, 12), 9}, static_cast<double>(cost)});
    }
    const HybridPartition partition = hybrid_partition(boxes, frame, 2, {0, 1});
    HybridPartition other = partition;
    for (int x = frame.x0 + 1; x < frame.x1; ++x) {
      other.regions.regions = {{{frame.x0, 2, x, 3}, 0}, {{x, 2, frame.x1, 3}, 1}};
      EXPECT_GE(pixels_sent(other, boxes, 2), pixels_sent(partition, boxes, 2)) << "seed " << seed;
    }
  }
}

// At every cut the halves differ by no more than the last box, each per rank.
TEST(HybridPartition, SharesWorkOutEvenly) {
  const Rect frame{0, 0, 960, 540};
  for (const auto scenery : testing::kSceneries) {
    std::vector<WeightedBox> boxes = testing::boxes(scenery, frame, 6000, 7);
    const double all =
        std::accumulate(boxes.begin(), boxes.end(), 0.0, [&](double sum, const WeightedBox& box) {
          return sum + (geometry::intersection(box.box, frame).empty() ? 0 : box.cost);
        });
    double largest = 0;
    for (const WeightedBox& box : boxes) largest = std::max(largest, box.cost);
    for (const int ranks : {1, 2, 3, 4, 7, 16, 31, 64}) {
      const auto costs =
          costs_of_owners(hybrid_partition(boxes, frame, ranks, {0, 0.5}), boxes, ranks);
      EXPECT_NEAR(std::accumulate(costs.begin(), costs.end(), 0.0), all, 1e-6 * all);
      EXPECT_LE(*std::max_element(costs.begin(), costs.end()), all / ranks + 2 * largest)
          << static_cast<int>(scenery) << ", " << ranks;
    }
  }
}

// A ground that costs as much as everything on it, and would keep one rank busy with half of all.
TEST(HybridPartition, SharesOutAmongEverybodyWhatIsTooMuchForOne) {
  const Rect frame{0, 0, 480, 270};
  std::vector<WeightedBox> boxes = testing::boxes(testing::Scenery::uniform, frame, 3000, 12);
  double all = 0;
  for (const WeightedBox& box : boxes) all += box.cost;
  boxes.push_back({{0, 135, 480, 270}, all});
  for (const int ranks : {2, 4, 9, 16, 64}) {
    const HybridPartition partition = hybrid_partition(boxes, frame, ranks);
    EXPECT_EQ(partition.owners.back(), kEverybody);
    EXPECT_EQ(std::count(partition.owners.begin(), partition.owners.end(), kEverybody), 1);
    const auto costs = costs_of_owners(partition, boxes, ranks);
    EXPECT_LE(*std::max_element(costs.begin(), costs.end()) * ranks / (2 * all), 1.25) << ranks;
    EXPECT_LT(pixels_sent(partition, boxes, ranks), frame.area() * ranks / 100);
  }
}

// Small boxes leave few pixels to be sent, and dealing boxes out without looking sends many.
TEST(HybridPartition, SendsFewPixels) {
  const Rect frame{0, 0, 480, 270};
  for (const auto scenery : {testing::Scenery::uniform, testing::Scenery::clusters}) {
    const std::vector<WeightedBox> boxes = testing::boxes(scenery, frame, 3000, 11);
    for (const int ranks : {2, 4, 9, 16}) {
      HybridPartition partition = hybrid_partition(boxes, frame, ranks, {0.5, 0.5});
      const std::int64_t sent = pixels_sent(partition, boxes, ranks);
      EXPECT_LT(sent, frame.area() * ranks / 100) << static_cast<int>(scenery) << ", " << ranks;
      for (std::size_t i = 0; i < boxes.size(); ++i)
        if (partition.owners[i] != kNobody) partition.owners[i] = static_cast<int>(i) % ranks;
      EXPECT_GT(pixels_sent(partition, boxes, ranks), 5 * sent);
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
