// The grid of costs covers the frame, and boxes count once.
#include "loadbalance/costs.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "comm/threads.h"
#include "loadbalance/partition.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

double total(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Costs, CellsCoverTheFrameExactlyOnce) {
  for (const Rect frame : {Rect{-3, 4, 100, 41}, Rect{0, 0, 1, 1}, Rect{7, 7, 20, 1000}}) {
    const Costs costs = make_costs(frame, 9, 31, {});
    EXPECT_LE(costs.columns, frame.width());
    EXPECT_LE(costs.rows, frame.height());
    int x = frame.x0;
    for (int i = 0; i < costs.columns; ++i) {
      EXPECT_EQ(costs.cell(i, 0).x0, x);
      EXPECT_GT(costs.cell(i, 0).width(), 0);
      x = costs.cell(i, 0).x1;
    }
    EXPECT_EQ(x, frame.x1);
    int y = frame.y0;
    for (int j = 0; j < costs.rows; ++j) {
      EXPECT_EQ(costs.cell(0, j).y0, y);
      EXPECT_GT(costs.cell(0, j).height(), 0);
      y = costs.cell(0, j).y1;
    }
    EXPECT_EQ(y, frame.y1);
  }
}

TEST(Costs, ABoxIsSplitEvenlyOverItsCells) {
  const std::vector<WeightedBox> boxes = {{{9, 0, 21, 11}, 6}};  // columns 0 to 2, rows 0 and 1
  const Costs costs = make_costs({0, 0, 40, 20}, 4, 2, boxes);
  EXPECT_EQ(costs.cells, (std::vector<double>{1, 1, 1, 0, 1, 1, 1, 0}));
  EXPECT_EQ(costs.cross_right, (std::vector<double>{3, 3, 0, 0, 3, 3, 0, 0}));
  EXPECT_EQ(costs.cross_down, (std::vector<double>{2, 2, 2, 0, 0, 0, 0, 0}));
  EXPECT_EQ(costs.boxes.size(), 1U);
}

TEST(Costs, BoxesOutsideAddNothingAndThoseAcrossTheBorderAddAll) {
  const std::vector<WeightedBox> boxes = {{{-10, -10, 0, 20}, 1},
                                          {{40, 0, 50, 20}, 2},
                                          {{5, 5, 5, 9}, 4},
                                          {{-1000, -1000, 5, 5}, 8},
                                          {{-1000000000, 3, 1000000000, 4}, 16}};
  const Costs costs = make_costs({0, 0, 40, 20}, 4, 2, boxes);
  EXPECT_EQ(costs.cells, (std::vector<double>{12, 4, 4, 4, 0, 0, 0, 0}));
}

TEST(Costs, OfAnEmptyFrame) {
  const std::vector<WeightedBox> boxes = {{{0, 0, 5, 5}, 1}};
  const Costs costs = make_costs({3, 3, 3, 9}, 8, 8, boxes);
  EXPECT_EQ(costs.columns, 1);
  EXPECT_EQ(total(costs.cells), 0);
}

TEST(Costs, AreFineEnoughForTheNumberOfParts) {
  const Rect frame{0, 0, 1920, 1080};
  EXPECT_EQ(cost_cell_side(frame, 1), 16);
  EXPECT_EQ(cost_cell_side(frame, 16), 8);
  EXPECT_EQ(cost_cell_side(frame, 64), 4);
  EXPECT_EQ(cost_cell_side(frame, 100000), 2);
  EXPECT_EQ(cost_cell_side({}, 1), 2);
  EXPECT_EQ(primitives_per_box(13000000, 64), 203);
  EXPECT_EQ(primitives_per_box(13000000, 16), 812);
  EXPECT_EQ(primitives_per_box(13000000, 4), 1024);
  EXPECT_EQ(primitives_per_box(32000, 64), 1);
}

TEST(Costs, BoxesOfAFrameStopGrowingInNumberWithTheParts) {
  for (const std::uint64_t primitives : {10'000'000ULL, 30'000'000ULL}) {
    const auto boxes = [&](int parts) {
      return primitives / static_cast<std::uint64_t>(primitives_per_box(primitives, parts));
    };
    EXPECT_GE(boxes(128), boxes(16));
    EXPECT_EQ(boxes(1024), boxes(256));
    EXPECT_LE(boxes(1 << 20), 140'000U);
  }
}

// Which pixels a cell has, and which cells a box overlaps, must agree.
TEST(Costs, EachBoxTouchesExactlyTheCellsItOverlaps) {
  const unsigned seed = 31;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto number = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  for (int k = 0; k < 500; ++k) {
    const Rect frame{-5, 3, -5 + number(1, 50), 3 + number(1, 50)};
    const int x = number(-10, 50), y = number(-10, 60);
    const WeightedBox box{{x, y, x + number(1, 20), y + number(1, 20)}, 1};
    const Costs costs = make_costs(frame, number(1, 60), number(1, 60), {box});
    int touched = 0;
    for (int j = 0; j < costs.rows; ++j) {
      for (int i = 0; i < costs.columns; ++i) {
        const bool overlaps = !geometry::intersection(costs.cell(i, j), box.box).empty();
        const double cost = costs.cells[static_cast<std::size_t>(j * costs.columns + i)];
        ASSERT_EQ(cost > 0, overlaps);
        touched += overlaps ? 1 : 0;
      }
    }
    ASSERT_NEAR(total(costs.cells), touched > 0 ? 1 : 0, 1e-12);
  }
}

TEST(GatherBoxes, StringsThemTogetherByRankOnTheFirst) {
  for (const int ranks : {1, 2, 3, 5}) {
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      const int rank = communicator.rank();
      std::vector<WeightedBox> boxes;
      for (int k = 0; k < rank; ++k) boxes.push_back({{rank, 0, rank + 1, 2}, 1.0 + k});
      const std::vector<WeightedBox> all = gather_boxes(boxes, communicator);
      if (rank != 0) {
        EXPECT_TRUE(all.empty());
        return;
      }
      ASSERT_EQ(all.size(), static_cast<std::size_t>(ranks * (ranks - 1) / 2));
      for (std::size_t k = 1; k < all.size(); ++k) EXPECT_LE(all[k - 1].box.x0, all[k].box.x0);
    });
  }
}

}  // namespace
}  // namespace delray::loadbalance
