// The order of cells keeps each distinct point once, for every number of threads.
#include "delaunay/order/cell_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "delaunay/order/finite_points.h"
#include "parallel/arena.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay::internal {
namespace {

TEST(CellOrder, KeepsEachPointOnceWithItsLowestRow) {
  for (const HardPoints& kind : hard_points()) {
    for (const std::size_t n : {1, 2, 40, 300, 3000}) {
      const Points points = kind.make(n, 3);
      std::map<std::pair<double, double>, std::uint32_t> lowest;
      for (std::uint32_t row = 0; row < n; ++row) {
        lowest.insert({{points[row].x, points[row].y}, row});
      }
      const CellOrder order = cell_order(view(points));
      ASSERT_EQ(order.points.size(), lowest.size()) << kind.name << ", " << n;
      ASSERT_EQ(order.rows.size(), lowest.size());
      for (std::size_t i = 0; i < lowest.size(); ++i) {
        const auto found = lowest.find({order.points[i].x, order.points[i].y});
        ASSERT_NE(found, lowest.end()) << kind.name;
        EXPECT_EQ(found->second, order.rows[i]) << kind.name;
        lowest[found->first] = 0xffffffffU;  // not a second time
      }
    }
  }
}

TEST(CellOrder, IsTheSameForEveryNumberOfThreads) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(40000, 4);
    const CellOrder expected = cell_order(view(points));
    for (const int threads : {2, 5}) {
      const CellOrder order =
          parallel::Arena(threads).execute([&] { return cell_order(view(points), threads); });
      EXPECT_EQ(order.box, expected.box) << kind.name;
      ASSERT_EQ(order.rows.size(), expected.rows.size()) << kind.name;
      ASSERT_EQ(order.points.size(), expected.points.size()) << kind.name;
      for (std::size_t i = 0; i < expected.rows.size(); ++i) {
        ASSERT_EQ(order.rows[i], expected.rows[i]) << kind.name << ", " << i;
        ASSERT_EQ(order.points[i], expected.points[i]) << kind.name << ", " << i;
      }
    }
  }
}

// A cut where the highest differing bit changes has all smaller coordinates before it.
TEST(CellGrid, NumbersGrowWithEitherCoordinate) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(300, 9);
    const CellGrid grid(finite_box(view(points)));
    for (std::size_t i = 1; i < points.size(); ++i) {
      const auto &p = points[i - 1], &q = points[i];
      const std::uint32_t a = grid.number(p), b = grid.number(q);
      if (a == b) continue;
      const bool by_y = split_by_y(a, b);
      EXPECT_EQ(a < b, by_y ? p.y < q.y : p.x < q.x) << kind.name << ", " << i;
    }
  }
}

TEST(CellGrid, SeparatesTheEndsOfAnyBox) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(50, 2);
    const Box2d box = finite_box(view(points));
    if (box.low == box.high) continue;
    const CellGrid grid(box);
    EXPECT_LT(grid.number(box.low), grid.number(box.high)) << kind.name;
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
