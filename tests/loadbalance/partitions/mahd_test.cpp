// MAHD on the report's worked example, and where there is no cost.
#include <gtest/gtest.h>

#include "loadbalance/partition.h"
#include "loadbalance/partitions/summed_area.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

// The worked example of Kohout, Selected Problems of Parallel Computer Graphics (2004), Figures 3.8
// and 3.9: the counts of a mesh, its summed-area table, and the table of each region of the final
// subdivision, which stands in the region's place.
constexpr int kColumns = 10, kRows = 13;
// clang-format off
const std::vector<double> kMesh = {
    1, 2, 3, 3, 2, 1, 0, 1, 0, 0,
    3, 6, 5, 4, 3, 2, 2, 2, 2, 0,
    4, 7, 6, 5, 5, 4, 3, 2, 3, 2,
    6, 8, 9, 7, 7, 6, 4, 3, 2, 1,
    6, 5, 6, 4, 3, 2, 2, 1, 2, 2,
    6, 5, 4, 3, 2, 1, 1, 1, 2, 1,
    7, 6, 5, 2, 1, 1, 0, 0, 1, 1,
    8, 9, 7, 2, 1, 0, 1, 0, 0, 0,
    6, 8, 9, 3, 2, 2, 1, 0, 0, 0,
    6, 5, 6, 5, 4, 3, 2, 1, 0, 0,
    6, 5, 4, 4, 6, 4, 3, 2, 1, 0,
    7, 6, 5, 4, 2, 2, 1, 1, 1, 1,
    6, 6, 6, 5, 4, 3, 2, 0, 1, 1};
const std::vector<double> kTable = {
     1,   3,   6,   9,  11,  12,  12,  13,  13,  13,
     4,  12,  20,  27,  32,  35,  37,  40,  42,  42,
     8,  23,  37,  49,  59,  66,  71,  76,  81,  83,
    14,  37,  60,  79,  96, 109, 118, 126, 133, 136,
    20,  48,  77, 100, 120, 135, 146, 155, 164, 169,
    26,  59,  92, 118, 140, 156, 168, 178, 189, 195,
    33,  72, 110, 138, 161, 178, 190, 200, 212, 219,
    41,  89, 134, 164, 188, 205, 218, 228, 240, 247,
    47, 103, 157, 190, 216, 235, 249, 259, 271, 278,
    53, 114, 174, 212, 242, 264, 280, 291, 303, 310,
    59, 125, 189, 231, 267, 293, 312, 325, 338, 345,
    66, 138, 207, 253, 291, 319, 339, 353, 367, 375,
    72, 150, 225, 276, 318, 349, 371, 385, 400, 409};
const std::vector<double> kSubdivided = {
     1,   3,   3,   6,   2,   3,   3,   4,   4,   4,
     4,  12,   8,  15,   5,   8,  10,  13,  15,  15,
     8,  23,  14,  26,  10,  17,  22,  27,  32,  34,
    14,  37,  23,  42,  17,  30,  39,  47,  54,  57,
    20,  48,  29,  52,  20,  35,  46,  55,  64,  69,
    26,  59,  33,  59,  22,  38,  50,  60,  71,  77,
    33,  72,  38,  66,  23,  40,  52,  62,  74,  81,
    41,  89,  45,  75,  24,  41,  54,  64,  76,  83,
     6,  14,  23,   3,   5,   7,   8,   8,   8,   8,
    12,  25,  40,   8,  14,  19,  22,  23,  23,  23,
    18,  36,  55,  12,  24,  33,  39,  42,  43,  43,
    25,  49,  73,  16,  30,  41,  48,  52,  54,  55,
    31,  61,  91,  21,  39,  53,  62,  66,  69,  71};
// clang-format on

Costs worked_example(int pixels_per_cell) {
  Costs costs = make_costs({5, 7, 5 + kColumns * pixels_per_cell, 7 + kRows * pixels_per_cell},
                           kColumns, kRows, {});
  costs.cells = kMesh;
  return costs;
}

Partition mahd(const Costs& costs, int parts) {
  return find_partitioner("mahd")->partition(costs, costs.frame, parts);
}

TEST(SummedArea, OfTheWorkedExample) {
  const SummedArea sums(kColumns, kRows, kMesh);
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      EXPECT_EQ(sums.at(i, j), kTable[static_cast<std::size_t>(j * kColumns + i)]) << i << ' ' << j;
    }
  }
}

TEST(Mahd, SplitsWorkedExampleIntoFiveParts) {
  for (const int scale : {1, 16}) {
    const Costs costs = worked_example(scale);
    const Partition partition = mahd(costs, 5);
    EXPECT_EQ(loads(costs, partition, 5), (std::vector<double>{89, 75, 83, 91, 71}));
    const Rect expected[] = {
        {0, 0, 2, 8}, {2, 0, 4, 8}, {4, 0, 10, 8}, {0, 8, 3, 13}, {3, 8, 10, 13}};
    ASSERT_EQ(partition.regions.size(), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      const Rect& cells = expected[k];
      EXPECT_EQ(partition.regions[k].owner, static_cast<int>(k));
      EXPECT_EQ(partition.regions[k].rect, (Rect{5 + cells.x0 * scale, 7 + cells.y0 * scale,
                                                 5 + cells.x1 * scale, 7 + cells.y1 * scale}));
    }
  }
}

TEST(Mahd, LeavesTheTablesOfTheWorkedExample) {
  const Costs costs = worked_example(1);
  const SummedArea sums(kColumns, kRows, kMesh);
  for (const Region& region : mahd(costs, 5).regions) {
    const Rect cells{region.rect.x0 - 5, region.rect.y0 - 7, region.rect.x1 - 5,
                     region.rect.y1 - 7};
    for (int j = cells.y0; j < cells.y1; ++j) {
      for (int i = cells.x0; i < cells.x1; ++i) {
        EXPECT_EQ(sums.sum({cells.x0, cells.y0, i + 1, j + 1}),
                  kSubdivided[static_cast<std::size_t>(j * kColumns + i)]);
      }
    }
  }
}

TEST(Mahd, WithoutCostCutsByArea) {
  const Costs costs = make_costs({0, 0, 64, 64}, 64, 64, {});
  for (const int parts : {2, 4, 8, 16}) {
    const Partition partition = mahd(costs, parts);
    ASSERT_EQ(partition.regions.size(), static_cast<std::size_t>(parts));
    for (const Region& region : partition.regions) EXPECT_EQ(region.rect.area(), 4096 / parts);
  }
}

TEST(Mahd, CutsTheOnlyExpensiveCellOff) {
  Costs costs = make_costs({0, 0, 8, 1}, 8, 1, {});
  costs.cells[5] = 1;
  const Partition partition = mahd(costs, 2);
  ASSERT_EQ(partition.regions.size(), 2U);
  EXPECT_EQ(partition.regions[0].rect, (Rect{0, 0, 5, 1}));
}

TEST(Mahd, MorePartsThanCellsLeavesSomeWithout) {
  const Costs costs = make_costs({0, 0, 100, 100}, 2, 1, {});
  const Partition partition = mahd(costs, 7);
  ASSERT_EQ(partition.regions.size(), 2U);
  EXPECT_EQ(partition.regions[0].rect, (Rect{0, 0, 50, 100}));
  EXPECT_EQ(partition.regions[1].rect, (Rect{50, 0, 100, 100}));
}

// No region can be worse than one cut's error allows: with uniform unit cells, 5 % at this size.
TEST(Mahd, BalancesUniformCosts) {
  Costs costs = make_costs({0, 0, 1920, 1080}, 192, 108, {});
  for (double& cost : costs.cells) cost = 1;
  for (int parts = 1; parts <= 16; ++parts) {
    for (const double load : loads(costs, mahd(costs, parts), parts)) {
      EXPECT_NEAR(load * parts / (192 * 108), 1, 0.05) << parts;
    }
  }
}

}  // namespace
}  // namespace delray::loadbalance
