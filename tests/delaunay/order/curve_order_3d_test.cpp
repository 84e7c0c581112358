// The order along the curve in space keeps every row once.
#include "delaunay/order/curve_order_3d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "delaunay/generate.h"
#include "parallel/arena.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay::internal {
namespace {

TEST(CurveOrder3d, KeepsEveryRowOnce) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (const std::size_t n : {0, 1, 40, 3000}) {
      const auto points = kind.make(n, 3);
      const PointRange range = finite_range(view(points));
      const CurveOrder3d order = curve_order_3d(view(points), range, 1);
      ASSERT_EQ(order.vertices.size(), n + 1);
      ASSERT_EQ(order.rounds.front(), 0U);
      ASSERT_EQ(order.rounds.back(), n);
      ASSERT_TRUE(std::ranges::is_sorted(order.rounds));
      std::vector<bool> seen(n, false);
      for (std::size_t i = 1; i <= n; ++i) {
        const std::uint32_t row = order.vertices[i].row;
        ASSERT_LT(row, n);
        EXPECT_FALSE(seen[row]) << kind.name << ", row " << row;
        seen[row] = true;
        EXPECT_EQ(order.vertices[i].position, points[row]) << kind.name << ", row " << row;
        for (int k = 0; k < 3; ++k) {
          EXPECT_FALSE(points[row][k] == 0 && std::signbit(order.vertices[i].position[k]));
        }
      }
    }
  }
}

TEST(CurveOrder3d, IsTheSameForEveryNumberOfThreads) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    const auto points = kind.make(40000, 4);
    const PointRange expected_range = finite_range(view(points));
    const CurveOrder3d expected = curve_order_3d(view(points), expected_range, 2);
    for (const int threads : {2, 5}) {
      parallel::Arena(threads).execute([&] {
        const PointRange range = finite_range(view(points), threads);
        EXPECT_EQ(range.low, expected_range.low) << kind.name;
        EXPECT_EQ(range.high, expected_range.high) << kind.name;
        EXPECT_EQ(range.grid_exponent, expected_range.grid_exponent) << kind.name;
        const CurveOrder3d order = curve_order_3d(view(points), range, 2, threads);
        EXPECT_EQ(order.rounds, expected.rounds) << kind.name;
        for (std::size_t i = 1; i <= points.size(); ++i) {
          ASSERT_EQ(order.vertices[i].row, expected.vertices[i].row) << kind.name << ", " << i;
        }
      });
    }
  }
}

// On a curve through all of them, neighbours of a dense set are near each other: a step is on
// average about as long as the distance to the nearest point, and none crosses the cube.
TEST(CurveOrder3d, NeighboursAreNear) {
  const auto points = generate_points("uniform", 30000, 3, 5).positions;
  const CurveOrder3d order = curve_order_3d(view(points), finite_range(view(points)), 3);
  const std::size_t first = order.rounds[order.rounds.size() - 2];
  EXPECT_LT(first, points.size() / 2);  // most points are in the last round
  const double spacing = 1 / std::cbrt(static_cast<double>(points.size()));
  double sum = 0, longest = 0;
  for (std::size_t i = first + 1; i < points.size(); ++i) {
    const double step = glm::length(order.vertices[i + 1].position - order.vertices[i].position);
    sum += step;
    longest = std::max(longest, step);
  }
  EXPECT_LT(sum / static_cast<double>(points.size() - first), 1.5 * spacing);
  EXPECT_LT(longest, 10 * spacing);
}

TEST(CurveOrder3d, NamesTheFirstRowThatIsNotFinite) {
  auto points = hard_points_3d().front().make(30000, 1);
  points[25000].y = std::numeric_limits<double>::infinity();
  points[17000].z = std::numeric_limits<double>::quiet_NaN();
  for (const int threads : {1, 3}) {
    try {
      parallel::Arena(threads).execute([&] { finite_range(view(points), threads); });
      ADD_FAILURE() << threads;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("row 17000 "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
