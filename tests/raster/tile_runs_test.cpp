#include "raster/internal/tile_runs.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "tests/raster/targets.h"

namespace delray::raster {
namespace {

TEST(TileRuns, ChangesAreWhereNeighboursDiffer) {
  const auto tile = std::make_unique<VisibilityTile>();
  const auto runs = std::make_unique<TileRuns>();
  for_each_target([&] {
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
      const int j0 = round % 2 == 0 ? 0 : static_cast<int>(random() % 30);
      const int j1 = round % 3 == 0 ? kTileSize : j0 + 1 + static_cast<int>(random() % 30);
      std::uint32_t number = kNothing;
      for (int pixel = 0; pixel < kTilePixels; ++pixel) {
        if (random() % 4 == 0)
          number = random() % 5 == 0 ? kNothing : static_cast<std::uint32_t>(random() % 3);
        // Depths make no difference.
        tile->key[pixel] = static_cast<std::int64_t>(std::uint64_t{random()} << 32 | number);
      }
      find_runs(*tile, j0, j1, *runs);
      const auto at = [&](int i, int j) { return number_of(tile->key[j * kTileSize + i]); };
      for (int j = j0; j < j1; ++j)
        for (int i = 0; i < kTileSize; ++i) {
          ASSERT_EQ(runs->numbers()[j * kTileSize + i], at(i, j));
          ASSERT_EQ(runs->changes_along[j] >> i & 1, i == 0 || at(i, j) != at(i - 1, j));
          ASSERT_EQ(runs->changes_down[j] >> i & 1, j == j0 || at(i, j) != at(i, j - 1));
        }
    }
  });
}

}  // namespace
}  // namespace delray::raster
