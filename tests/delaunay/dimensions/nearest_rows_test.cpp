// The triangulation finds the same neighbours as comparing all points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "delaunay/dimensions.h"

namespace delray::delaunay {
namespace {

// On a lattice, so that many distances are equal, or anywhere.
PointTable random_points(int dim, std::size_t n, std::uint64_t seed, bool on_lattice) {
  PointTable points{dim, {}};
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < n * static_cast<std::size_t>(dim); ++i) {
    points.coordinates.push_back(on_lattice ? static_cast<double>(random() % 3)
                                            : std::uniform_real_distribution<>(0, 1)(random));
  }
  return points;
}

TEST(NearestRows, AreThoseOfComparingAll) {
  for (int dim = 2; dim <= 6; ++dim) {
    for (const bool on_lattice : {false, true}) {
      for (const std::size_t n : {1, 3, 9, 60}) {
        const std::uint64_t seed = n + static_cast<std::uint64_t>(dim);
        SCOPED_TRACE(std::to_string(dim) + "D, " + std::to_string(n) + " points, seed " +
                     std::to_string(seed) + (on_lattice ? ", lattice" : ""));
        const PointTable points = random_points(dim, n, seed, on_lattice);
        const Triangulation triangulation = triangulate_dimensions(points.view(), dim);
        for (const std::uint32_t of : {std::uint32_t{0}, static_cast<std::uint32_t>(n - 1)}) {
          std::vector<double> expected;
          for (std::size_t row = 0; row < n; ++row) {
            double sum = 0;
            for (int k = 0; k < dim; ++k) {
              const double d = points.view()(row, k) - points.view()(of, k);
              sum += d * d;
            }
            if (row != of) expected.push_back(std::sqrt(sum));
          }
          std::ranges::sort(expected);
          const auto found = nearest_rows(points.view(), triangulation, of, n);
          ASSERT_EQ(found.size(), expected.size());
          for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].distance, expected[i]) << i;
            EXPECT_NE(found[i].row, of);
          }
          EXPECT_EQ(nearest_rows(points.view(), triangulation, of, 2).size(),
                    std::min<std::size_t>(2, n - 1));
        }
      }
    }
  }
}

TEST(NearestRows, RowsThatAreNotThereAreRefused) {
  const PointTable points = random_points(3, 5, 1, false);
  const Triangulation triangulation = triangulate_dimensions(points.view(), 3);
  EXPECT_THROW(nearest_rows(points.view(), triangulation, 5, 1), std::invalid_argument);
}

}  // namespace
}  // namespace delray::delaunay
