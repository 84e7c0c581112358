// Bisection of sets of cells: shares, order and cost.
#include "loadbalance/partitions/grid_bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/loadbalance/boxes.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;
using internal::GridBisection;

Costs scenery_costs(testing::Scenery scenery, int columns, int rows, unsigned seed) {
  const Rect frame{0, 0, 4 * columns, 4 * rows};
  return make_costs(frame, columns, rows,
                    testing::boxes(scenery, frame, std::max(1, columns * rows / 8), seed));
}

double cost_of(const Costs& costs, const GridBisection& bisection,
               std::span<const std::uint32_t> cells) {
  double sum = 0;
  for (const std::uint32_t cell : cells) sum += costs.cells[bisection.place(cell)];
  return sum;
}

TEST(GridBisection, NamesEveryCellOnceInOrder) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {7, 3}, {64, 64}, {1, 200}, {333, 17}}) {
    const GridBisection bisection(make_costs({0, 0, 400, 400}, columns, rows, {}));
    const std::vector<std::uint32_t> cells = bisection.cells();
    ASSERT_EQ(cells.size(), static_cast<std::size_t>(columns * rows));
    for (std::size_t k = 0; k < cells.size(); ++k) ASSERT_EQ(bisection.place(cells[k]), k);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
  }
}

// Sets of any form: what random cuts of random shares leave.
TEST(GridBisection, CutsSetsInTwoOrderedParts) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return std::uniform_int_distribution<int>(low, high)(random);
    };
    const Costs costs =
        scenery_costs(testing::kSceneries[seed % 4], number(1, 90), number(2, 90), seed);
    GridBisection bisection(costs);
    std::vector<std::uint32_t> cells = bisection.cells();
    std::span<std::uint32_t> set = cells;
    while (set.size() >= 2) {
      const std::vector<std::uint32_t> before(set.begin(), set.end());
      const std::size_t taken = bisection.cut(set, number(1, 9) / 10.0);
      ASSERT_GE(taken, 1U);
      ASSERT_LT(taken, set.size());
      const auto middle = set.begin() + static_cast<std::ptrdiff_t>(taken);
      ASSERT_TRUE(std::is_sorted(set.begin(), middle));
      ASSERT_TRUE(std::is_sorted(middle, set.end()));
      std::vector<std::uint32_t> merged;
      std::merge(set.begin(), middle, middle, set.end(), std::back_inserter(merged));
      ASSERT_EQ(merged, before);
      set = number(0, 1) == 0 ? set.first(taken) : set.subspan(taken);
    }
  }
}

TEST(GridBisection, TakesTheShareThatIsWanted) {
  for (const testing::Scenery scenery : testing::kSceneries) {
    const Costs costs = scenery_costs(scenery, 150, 100, 4);
    for (const double share : {0.5, 1 / 3.0, 0.8}) {
      GridBisection bisection(costs);
      std::vector<std::uint32_t> cells = bisection.cells();
      const double wanted = share * cost_of(costs, bisection, cells);
      const std::size_t taken = bisection.cut(cells, share);
      const double cost = cost_of(costs, bisection, std::span(cells).first(taken));
      EXPECT_NEAR(cost / wanted, 1, 0.0201) << static_cast<int>(scenery) << ' ' << share;
    }
  }
}

// Two boards of cells that are tied much, and little between them along a winding line: the cut
// has to follow it, on every level.
TEST(GridBisection, FollowsAWindingLineThatLittleCrosses) {
  constexpr int kSide = 94;  // three periods of the line, so that it halves the grid
  Costs costs = make_costs({0, 0, kSide, kSide}, kSide, kSide, {});
  const auto left = [](int i, int j) {
    return i < kSide / 2 + static_cast<int>(std::lround(4 * std::sin(0.2 * j)));
  };
  const auto at = [](int i, int j) { return static_cast<std::size_t>(j * kSide + i); };
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      costs.cells[at(i, j)] = 1;
      if (i + 1 < kSide) costs.cross_right[at(i, j)] = left(i, j) == left(i + 1, j) ? 100 : 0;
      if (j + 1 < kSide) costs.cross_down[at(i, j)] = left(i, j) == left(i, j + 1) ? 100 : 0;
    }
  }
  GridBisection bisection(costs);
  std::vector<std::uint32_t> cells = bisection.cells();
  const std::size_t taken = bisection.cut(cells, 0.5);
  std::vector<bool> inside(costs.cells.size());
  for (const std::uint32_t cell : std::span(cells).first(taken)) {
    inside[bisection.place(cell)] = true;
  }
  double crossing = 0;
  for (int j = 0; j + 1 < kSide; ++j) {
    for (int i = 0; i + 1 < kSide; ++i) {
      if (inside[at(i, j)] != inside[at(i + 1, j)]) crossing += costs.cross_right[at(i, j)];
      if (inside[at(i, j)] != inside[at(i, j + 1)]) crossing += costs.cross_down[at(i, j)];
    }
  }
  EXPECT_LE(crossing, 100 * kSide / 10);  // of a straight line
}

std::uint64_t looked_at(const Costs& costs, int parts) {
  GridBisection bisection(costs);
  std::vector<std::uint32_t> cells = bisection.cells();
  std::vector<std::span<std::uint32_t>> sets{cells};
  for (int count = 1; count < parts; count *= 2) {
    std::vector<std::span<std::uint32_t>> halves;
    for (const auto set : sets) {
      const std::size_t taken = bisection.cut(set, 0.5);
      halves.push_back(set.first(taken));
      halves.push_back(set.subspan(taken));
    }
    sets = std::move(halves);
  }
  return bisection.looked_at();
}

// Each halving of the parts looks at every cell a few times and not more often where there are
// more of them.
TEST(GridBisection, LooksAtEachCellAFewTimes) {
  for (const testing::Scenery scenery : testing::kSceneries) {
    SCOPED_TRACE(static_cast<int>(scenery));
    const auto few = static_cast<double>(looked_at(scenery_costs(scenery, 96, 64, 5), 16));
    const auto many = static_cast<double>(looked_at(scenery_costs(scenery, 384, 256, 5), 16));
    EXPECT_LE(many, 16 * few);
    EXPECT_LE(many, 4 * 6 * 384 * 256);
  }
}

}  // namespace
}  // namespace delray::loadbalance
