#include "delaunay/tiles/count_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace delray::delaunay {
namespace {

std::vector<glm::dvec3> random_places(std::mt19937_64& random, std::size_t n, double scale,
                                      double away) {
  std::uniform_real_distribution<> unit(-1, 1);
  std::vector<glm::dvec3> places;
  for (std::size_t i = 0; i < n; ++i) {
    places.emplace_back(away + scale * unit(random), away + scale * 0.1 * unit(random),
                        away + scale * unit(random));
  }
  return places;
}

// However a box grows, and whichever grids are added, counts are those of a grid that knew the
// whole box from the start.
TEST(CountGrid, CountsAsIfItHadKnownTheBox) {
  std::mt19937_64 random(5);
  for (const int dim : {2, 3}) {
    for (int i = 0; i < 200; ++i) {
      const double scale = std::pow(10, static_cast<int>(random() % 600) - 300);
      const auto places = random_places(random, 60, scale, (i % 3) * 1000 * scale);
      const int most = 2 + static_cast<int>(random() % 20);
      CountGrid whole(dim, most), grown(dim, most), other(dim, most);
      geometry::Box3d box;
      for (const glm::dvec3& place : places) box.include(place);
      whole.cover(box);
      for (std::size_t k = 0; k < places.size(); ++k) {
        whole.add(places[k]);
        CountGrid& grid = k % 4 == 0 ? other : grown;
        grid.cover({places[k], places[k]});
        grid.add(places[k]);
      }
      grown.add(other);
      ASSERT_EQ(grown.lattice().cells(), whole.lattice().cells()) << i;
      ASSERT_EQ(std::vector(grown.counts().begin(), grown.counts().end()),
                std::vector(whole.counts().begin(), whole.counts().end()))
          << i;
      for (int k = 0; k < dim; ++k) ASSERT_LE(whole.lattice().cells_along(k), most);
    }
  }
}

TEST(CountGrid, TakesExtremeBoxes) {
  constexpr double kLargest = std::numeric_limits<double>::max(),
                   kLeast = std::numeric_limits<double>::denorm_min();
  for (const auto& [low, high] : {std::pair(0.0, 0.0),
                                  {-kLargest, kLargest},
                                  {-kLeast, kLeast},
                                  {0.0, kLeast},
                                  {kLargest, kLargest},
                                  {1e300, std::nextafter(1e300, 2e300)},
                                  {-1.0, 1.0}}) {
    CountGrid grid(3, 8);
    grid.cover({glm::dvec3(low), glm::dvec3(high)});
    grid.add(glm::dvec3(low));
    grid.add(glm::dvec3(high));
    EXPECT_EQ(std::accumulate(grid.counts().begin(), grid.counts().end(), std::uint64_t{0}), 2U)
        << low << " " << high;
    EXPECT_LE(grid.lattice().cells(), 512U);
  }
  const CountGrid empty(2, 8);
  EXPECT_EQ(empty.counts().size(), 1U);
}

}  // namespace
}  // namespace delray::delaunay
