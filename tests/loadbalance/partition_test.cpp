// Promises of every partition of the table.
#include "loadbalance/partition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

  // Uniform, concentrated in a few cells, absent, of sizes that do not fit each other, or of the
  // boxes; sometimes with boxes.
  Costs costs() {
    const Rect frame{number(-20, 20), number(-20, 20), number(20, 160), number(20, 120)};
    const auto boxes = testing::boxes(testing::kSceneries[number(0, 3)], frame,
                                      number(0, 1) * number(1, 200), engine_());
    Costs costs = make_costs(frame, number(1, 70), number(1, 70), boxes);
    const int kind = number(0, 4);
    if (kind == 4) return costs;
    for (double& cost : costs.cells) {
      const int value = number(0, 99);
      cost = kind == 0   ? 0
             : kind == 1 ? value
             : kind == 2 ? (value < 3 ? 1e6 : 0)
                         : std::pow(10.0, value - 50);
    }
    return costs;
  }

 private:
  std::mt19937 engine_;
};

void expect_exact_cover(const Partition& partition, const Rect& frame, int parts) {
  ASSERT_EQ(partition.frame, frame);
  std::vector<int> count(static_cast<std::size_t>(frame.area()));
  for (const Region& region : partition.regions) {
    ASSERT_GE(region.owner, 0);
    ASSERT_LT(region.owner, parts);
    ASSERT_EQ(geometry::intersection(region.rect, frame), region.rect);
    for (int y = region.rect.y0; y < region.rect.y1; ++y) {
      for (int x = region.rect.x0; x < region.rect.x1; ++x) {
        ++count[static_cast<std::size_t>((y - frame.y0) * frame.width() + x - frame.x0)];
      }
    }
  }
  for (const int times : count) ASSERT_EQ(times, 1);
}

TEST(Partitioners, CoverTheFrameExactlyOnce) {
  for (const Partitioner& partitioner : partitioners()) {
    for (unsigned seed = 0; seed < 64; ++seed) {
      SCOPED_TRACE(std::string(partitioner.name) + ", seed " + std::to_string(seed));
      Random random(seed);
      const Costs costs = random.costs();
      const int parts = static_cast<int>(seed) + 1;
      expect_exact_cover(partitioner.partition(costs, costs.frame, parts), costs.frame, parts);
    }
  }
}

TEST(Partitioners, TakeTinyAndEmptyFrames) {
  for (const Partitioner& partitioner : partitioners()) {
    for (const Rect frame :
         {Rect{0, 0, 0, 0}, Rect{5, 5, 5, 90}, Rect{3, 4, 4, 5}, Rect{0, 0, 1, 9}}) {
      const Costs costs = make_costs(frame, 4, 4, {});
      for (const int parts : {1, 2, 7, 64}) {
        expect_exact_cover(partitioner.partition(costs, frame, parts), frame, parts);
      }
    }
  }
}

TEST(Partitioners, GiveTheSameForTheSame) {
  for (const Partitioner& partitioner : partitioners()) {
    const Costs costs = Random(5).costs();
    const auto first = partitioner.partition(costs, costs.frame, 13).regions;
    const auto second = partitioner.partition(costs, costs.frame, 13).regions;
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      EXPECT_EQ(first[k].rect, second[k].rect);
      EXPECT_EQ(first[k].owner, second[k].owner);
    }
  }
}

TEST(Partitioners, AreFoundByName) {
  for (const Partitioner& partitioner : partitioners()) {
    EXPECT_EQ(find_partitioner(partitioner.name), &partitioner);
  }
  for (const char* name :
       {"mahd", "kd-split", "graph", "whitman", "whelan", "roble", "interlaced"}) {
    EXPECT_NE(find_partitioner(name), nullptr) << name;
  }
  EXPECT_EQ(find_partitioner("nonsense"), nullptr);
}

TEST(Interlaced, GivesEveryPartMuchTheSameArea) {
  const Costs costs = make_costs({0, 0, 1920, 1080}, 1, 1, {});
  for (int parts = 1; parts <= 64; ++parts) {
    std::vector<double> area(static_cast<std::size_t>(parts));
    const Partition partition =
        find_partitioner("interlaced")->partition(costs, costs.frame, parts);
    EXPECT_GE(partition.regions.size(), static_cast<std::size_t>(16 * parts));
    for (const Region& region : partition.regions) {
      area[static_cast<std::size_t>(region.owner)] += static_cast<double>(region.rect.area());
    }
    for (const double pixels : area) EXPECT_NEAR(pixels * parts / (1920 * 1080), 1, 0.15) << parts;
  }
}

TEST(Interlaced, EveryColumnOfBlocksMeetsAllParts) {
  const Costs costs = make_costs({0, 0, 1024, 1024}, 1, 1, {});
  for (int parts = 2; parts <= 16; ++parts) {
    std::set<int> column, row;
    for (const Region& region :
         find_partitioner("interlaced")->partition(costs, costs.frame, parts).regions) {
      if (region.rect.x0 == 0) column.insert(region.owner);
      if (region.rect.y0 == 0) row.insert(region.owner);
    }
    EXPECT_EQ(column.size(), static_cast<std::size_t>(parts));
    EXPECT_EQ(row.size(), static_cast<std::size_t>(parts));
  }
}

TEST(Loads, CountPartsOfCellsByArea) {
  Costs costs = make_costs({10, 10, 14, 12}, 2, 1, {});
  costs.cells = {8, 2};
  const Partition partition{costs.frame,
                            {{{10, 10, 11, 12}, 0}, {{11, 10, 14, 11}, 2}, {{11, 11, 14, 12}, 2}}};
  EXPECT_EQ(loads(costs, partition, 3), (std::vector<double>{4, 0, 6}));
}

TEST(Loads, AddUpToTheTotal) {
  for (unsigned seed = 100; seed < 130; ++seed) {
    Random random(seed);
    Costs costs = random.costs();
    for (double& cost : costs.cells) cost = random.number(0, 1000);
    double total = 0, sum = 0;
    for (const double cost : costs.cells) total += cost;
    for (const Partitioner& partitioner : partitioners()) {
      sum = 0;
      for (const double load : loads(costs, partitioner.partition(costs, costs.frame, 7), 7)) {
        sum += load;
      }
      EXPECT_NEAR(sum, total, 1e-9 * total) << partitioner.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
