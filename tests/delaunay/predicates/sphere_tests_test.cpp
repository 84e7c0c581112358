// Predicates of one mesh against those for any points.
#include "delaunay/predicates/sphere_tests.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "delaunay/order/curve_order_3d.h"
#include "delaunay/predicates.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay::internal {
namespace {

TEST(SphereTests, HaveTheSignsOfThePredicatesForAnyPoints) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    int zeros = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const auto p = kind.make(24, seed);
      const SphereTests tests(finite_range(view(p)));
      for (std::size_t i = 0; i + 4 < p.size(); ++i) {
        const int turn = tests.orient3d(p[i], p[i + 1], p[i + 2], p[i + 3]);
        const int inside = tests.insphere(p[i], p[i + 1], p[i + 2], p[i + 3], p[i + 4]);
        EXPECT_EQ(turn, delaunay::orient3d(p[i], p[i + 1], p[i + 2], p[i + 3]))
            << kind.name << ", seed " << seed << ", point " << i;
        EXPECT_EQ(inside, delaunay::insphere(p[i], p[i + 1], p[i + 2], p[i + 3], p[i + 4]))
            << kind.name << ", seed " << seed << ", point " << i;
        zeros += inside == 0 ? 1 : 0;
      }
    }
    if (kind.name == "exactly on a sphere") {
      EXPECT_GT(zeros, 100);
    }
  }
}

// As large as they may be, so that every word is used and every sign and carry occurs.
TEST(WideDeterminants, HaveTheSignsOfThePredicatesForLargeIntegers) {
  std::mt19937_64 random(5);
  const glm::dvec3 origin(0);
  for (int turn = 0; turn < 3000; ++turn) {
    std::vector<Integers3> integers(4);
    std::vector<glm::dvec3> points;
    for (Integers3& p : integers) {
      for (auto& x : p) {
        // Few values, so that signs of every kind and zeros occur; all are doubles.
        const auto small = static_cast<std::int64_t>(random() % 5) - 2;
        x = small * ((std::int64_t{1} << 60) - (std::int64_t{1} << 20) * (random() % 2 != 0));
      }
      points.emplace_back(p[0], p[1], p[2]);
    }
    EXPECT_EQ(wide_orient_sign(integers[0], integers[1], integers[2]),
              delaunay::orient3d(origin, points[0], points[1], points[2]));
    EXPECT_EQ(wide_insphere_sign(integers[0], integers[1], integers[2], integers[3]),
              delaunay::insphere(points[0], points[1], points[2], points[3], origin));
  }
}

}  // namespace
}  // namespace delray::delaunay::internal
