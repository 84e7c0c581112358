// Triangulations of four dimensions are those of CGAL where points are in general position, and
// have as many points and span the same hull where they are not.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench/peers/cgald.h"
#include "delaunay/dimensions.h"

namespace delray::delaunay {
namespace {

PointTable random_table(std::size_t n, std::uint64_t seed, double (*coordinate)(std::mt19937_64&)) {
  PointTable points{4, {}};
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < 4 * n; ++i) points.coordinates.push_back(coordinate(random));
  return points;
}

TEST(Cgal4d, GivesTheSameSimplices) {
  const auto uniform = [](std::mt19937_64& random) {
    return std::uniform_real_distribution<>(0, 1)(random);
  };
  const auto gauss = [](std::mt19937_64& random) { return std::normal_distribution<>()(random); };
  const auto cubed = [](std::mt19937_64& random) {
    return std::pow(std::uniform_real_distribution<>(-1, 1)(random), 3);
  };
  std::uint64_t seed = 0;
  for (double (*const coordinate)(std::mt19937_64&) : {+uniform, +gauss, +cubed}) {
    for (const std::size_t n : {5, 30, 400}) {
      const PointTable points = random_table(n, ++seed, coordinate);
      const Triangulation ours = triangulate_dimensions(points.view(), 4, seed);
      const Triangulation cgal = bench::triangulate_with_cgal4(points.coordinates);
      EXPECT_EQ(hash(ours), hash(cgal)) << "seed " << seed << ", n " << n;
      EXPECT_EQ(ours.hull_facets, cgal.hull_facets) << "seed " << seed << ", n " << n;
      EXPECT_EQ(ours.distinct, cgal.distinct) << "seed " << seed << ", n " << n;
      EXPECT_TRUE(verify_dimensions(points.view(), 4, cgal.vertices).canonical);
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
