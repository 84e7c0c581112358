#include "delaunay/tiles/tile_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "delaunay/generate.h"

namespace delray::delaunay {
namespace {

std::vector<std::uint64_t> cut_evenly(const std::vector<glm::dvec3>& places, int dim, int tiles,
                                      const char* partition = "kd-split") {
  return cut_places(places, dim, tiles, *loadbalance::find_partitioner(partition))
      .count(places, tiles);
}

std::uint64_t sum_of(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

TEST(TileCut, GivesTilesAboutAsManyPoints) {
  for (const int dim : {2, 3}) {
    for (const char* kind : {"uniform", "gauss", "cluster", "grid", "arc", "spiral", "two-lines",
                             "collinear", "parabola", "far", "large", "small"}) {
      const auto places = generate_points(kind, 20000, dim, 1).positions;
      for (const int tiles : {1, 2, 7, 16, 64}) {
        SCOPED_TRACE(std::string(kind) + ", " + std::to_string(dim) + "D, " +
                     std::to_string(tiles) + " tiles");
        const auto counts = cut_evenly(places, dim, tiles);
        EXPECT_EQ(sum_of(counts), 20000U);
        // Of a lattice whole rows are on a side of a plane, of two lines in space a whole one.
        const double most = std::string(kind) == "grid"        ? 1.35
                            : std::string(kind) == "two-lines" ? 1.8
                                                               : 1.1;
        EXPECT_LE(static_cast<double>(*std::ranges::max_element(counts)), most * 20000 / tiles);
      }
    }
  }
}

// Four cubes in a row, of points 0.05 apart: 400 lie in a layer along a cut, 1200 in the three that
// feel it, which cost three times as much. The inner cubes have two cuts.
TEST(TileCut, TilesBetweenOthersGetFewerPointsWhereCutsCost) {
  auto places = generate_points("uniform", 32000, 3, 1).positions;
  for (glm::dvec3& place : places) place.x *= 4;
  const auto& partitioner = *loadbalance::find_partitioner("kd-split");
  const auto counts = cut_places(places, 3, 4, partitioner, 1).count(places, 4);
  EXPECT_EQ(sum_of(counts), 32000U);
  constexpr double kCut = 2 * 1200;
  for (std::size_t i = 0; i < 4; ++i) {
    const double cuts = i == 0 || i == 3 ? 1 : 2;
    EXPECT_NEAR(static_cast<double>(counts[i]) + kCut * cuts, 8000 + 1.5 * kCut, 350) << i;
  }
  // A place that stands for eight points has them half as far apart as the places.
  const auto sampled = cut_places(places, 3, 4, partitioner, 8).count(places, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const double cuts = i == 0 || i == 3 ? 1 : 2;
    EXPECT_NEAR(static_cast<double>(sampled[i]) + kCut / 2 * cuts, 8000 + 1.5 * kCut / 2, 250) << i;
  }
}

TEST(TileCut, CutsManyTilesEvenly) {
  const auto places = generate_points("cluster", 100000, 2, 3).positions;
  const auto counts = cut_evenly(places, 2, 1024);
  EXPECT_EQ(sum_of(counts), 100000U);
  EXPECT_LE(*std::ranges::max_element(counts), 120U);
  EXPECT_GE(*std::ranges::min_element(counts), 78U);
}

TEST(TileCut, TakesEveryPartition) {
  const auto places = generate_points("cluster", 5000, 3, 1).positions;
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
    for (const int dim : {2, 3}) {
      for (const int tiles : {2, 9}) {
        const auto counts = cut_evenly(places, dim, tiles, partitioner.name);
        EXPECT_EQ(sum_of(counts), 5000U) << partitioner.name;
        // Some cut cells to patterns that know nothing of what lies in them.
        EXPECT_LT(*std::ranges::max_element(counts), 5000U) << partitioner.name;
      }
    }
  }
}

TEST(TileCut, TakesDegeneratePlaces) {
  constexpr double kLargest = std::numeric_limits<double>::max(),
                   kLeast = std::numeric_limits<double>::denorm_min();
  for (const auto& [low, high] : {std::pair(0.0, 0.0),
                                  {-kLargest, kLargest},
                                  {-kLeast, kLeast},
                                  {0.0, kLeast},
                                  {kLargest, kLargest},
                                  {1e300, std::nextafter(1e300, 2e300)},
                                  {-1.0, 1.0}}) {
    for (const int dim : {2, 3}) {
      for (const int tiles : {1, 2, 5}) {
        const std::vector<glm::dvec3> places = {glm::dvec3(low), glm::dvec3(high), glm::dvec3(low)};
        const auto counts = cut_evenly(places, dim, tiles);
        EXPECT_EQ(sum_of(counts), 3U) << low << " " << high;
        if (tiles > 1 && low * 0.5 < high * 0.5) {
          EXPECT_LE(*std::ranges::max_element(counts), 2U) << low << " " << high;
        }
      }
    }
  }
  EXPECT_EQ(sum_of(cut_evenly({}, 2, 4)), 0U);
}

// Equal points and rows of a lattice lie in one tile, whatever that does to the counts.
TEST(TileCut, PutsEqualPlacesInOneTile) {
  for (const char* kind : {"duplicates", "equal", "cocircular"}) {
    auto places = generate_points(kind, 3000, 2, 1).positions;
    const TileCut made = cut_places(places, 2, 8, *loadbalance::find_partitioner("kd-split"));
    std::ranges::sort(places, [](const glm::dvec3& a, const glm::dvec3& b) {
      return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (places[i].x != places[i - 1].x || places[i].y != places[i - 1].y) continue;
      ASSERT_EQ(made.tile_of(places[i]), made.tile_of(places[i - 1])) << kind << " " << i;
    }
  }
}

TEST(TileCut, RanksHaveRunsOfTiles) {
  for (const int tiles : {1, 5, 16, 33}) {
    for (const int ranks : {1, 2, 7, 40}) {
      for (int tile = 0; tile < tiles; ++tile) {
        const int rank = rank_of_tile(tile, ranks, tiles);
        EXPECT_LE(first_tile(rank, ranks, tiles), tile);
        EXPECT_GT(first_tile(rank + 1, ranks, tiles), tile);
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
