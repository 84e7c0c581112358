#include "delaunay/tiles/tile_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "delaunay/generate.h"

namespace delray::delaunay {
namespace {

struct Cut {
  std::vector<std::uint64_t> points;  // of each tile, by where they fall
  std::vector<std::uint64_t> counted;
};

Cut cut(const std::vector<glm::dvec3>& places, int dim, int tiles, const char* partition) {
  CountGrid grid(dim, cells_along_axis(dim, static_cast<std::uint64_t>(tiles)));
  geometry::Box3d box;
  for (const glm::dvec3& place : places) box.include(place);
  grid.cover(box);
  for (const glm::dvec3& place : places) grid.add(place);
  const TileCut made(grid.lattice(), grid.counts(), tiles,
                     *loadbalance::find_partitioner(partition));
  Cut result{std::vector<std::uint64_t>(static_cast<std::size_t>(tiles)),
             made.points_of_tiles(grid.counts())};
  for (const glm::dvec3& place : places) {
    ++result.points.at(static_cast<std::size_t>(made.tile_of(place)));
  }
  return result;
}

TEST(TileCut, GivesTilesAboutAsManyPoints) {
  for (const int dim : {2, 3}) {
    for (const char* kind : {"uniform", "gauss"}) {
      const auto places = generate_points(kind, 60000, dim, 1).positions;
      for (const int tiles : {1, 2, 7, 16, 64}) {
        SCOPED_TRACE(std::string(kind) + ", " + std::to_string(dim) + "D, " +
                     std::to_string(tiles) + " tiles");
        const Cut made = cut(places, dim, tiles, "kd-split");
        EXPECT_EQ(made.points, made.counted);
        EXPECT_EQ(std::accumulate(made.points.begin(), made.points.end(), std::uint64_t{0}),
                  60000U);
        const double mean = 60000.0 / tiles;
        EXPECT_LE(static_cast<double>(*std::ranges::max_element(made.points)), 1.35 * mean);
      }
    }
  }
}

TEST(TileCut, TakesEveryPartition) {
  const auto places = generate_points("cluster", 5000, 3, 1).positions;
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
    for (const int dim : {2, 3}) {
      const Cut made = cut(places, dim, 9, partitioner.name);
      EXPECT_EQ(std::accumulate(made.points.begin(), made.points.end(), std::uint64_t{0}), 5000U)
          << partitioner.name;
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
