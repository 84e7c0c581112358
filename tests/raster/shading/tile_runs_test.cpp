#include "raster/shading/tile_runs.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>

#include "tests/support/targets.h"

namespace delray::raster {
namespace {

TEST(TileRuns, ChangesAreWhereNeighboursDiffer) {
  const auto tile = std::make_unique<VisibilityTile>();
  const auto runs = std::make_unique<TileRuns>();
  tests::for_each_target([&] {
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
      for (int j = j0; j < j1; ++j) {
        for (int i = 0; i < kTileSize; ++i) {
          ASSERT_EQ(runs->numbers()[j * kTileSize + i], at(i, j));
          ASSERT_EQ(runs->changes_along[j] >> i & 1, i == 0 || at(i, j) != at(i - 1, j));
          ASSERT_EQ(runs->shown[j] >> i & 1, at(i, j) != kNothing);
          ASSERT_EQ(runs->changes_down[j] >> i & 1, j == j0 || at(i, j) != at(i, j - 1));
        }
      }
    }
  });
}

TEST(TileRuns, AllTrianglesOfTheirPixelsAreFound) {
  const auto tile = std::make_unique<VisibilityTile>();
  const auto runs = std::make_unique<TileRuns>();
  const auto groups = std::make_unique<TileGroups>();
  tests::for_each_target([&] {
    std::mt19937 random(2);
    for (int round = 0; round < 30; ++round) {
      const int i0 = static_cast<int>(random() % 20) * (round % 2), j0 = round % 3 * 7;
      const int i1 = kTileSize - static_cast<int>(random() % 20) * (round % 2);
      const int j1 = kTileSize - static_cast<int>(random() % 20) * (round % 3);
      const std::uint32_t side = 1 + static_cast<std::uint32_t>(random()) % 9;
      for (int pixel = 0; pixel < kTilePixels; ++pixel) {
        const auto i = static_cast<std::uint32_t>(pixel % kTileSize);
        const auto j = static_cast<std::uint32_t>(pixel / kTileSize);
        const std::uint32_t square = j / side * 1000 + i / side;
        const std::uint32_t number = square % 7 == 0 ? kNothing : square;
        tile->key[pixel] = static_cast<std::int64_t>(std::uint64_t{random()} << 32 | number);
      }
      find_runs(*tile, j0, j1, *runs);
      groups->clear();
      const std::uint64_t shown = add_runs(*runs, i0, j0, i1, j1, *groups);
      groups->number_triangles();
      std::uint64_t expected_shown = 0;
      std::set<std::uint32_t> expected;
      for (int j = j0; j < j1; ++j) {
        const RowRuns row = row_of(*runs, i0, j);
        for (int i = i0; i < i1; ++i) {
          const std::uint32_t number = number_of(tile->key[j * kTileSize + i]);
          ASSERT_EQ(row.numbers[i - i0], number);
          ASSERT_EQ(row.shown >> (i - i0) & 1, number != kNothing);
          ASSERT_EQ(row.starts >> (i - i0) & 1,
                    i == i0 || number != number_of(tile->key[j * kTileSize + i - 1]));
          if (number == kNothing) continue;
          ++expected_shown;
          expected.insert(number);
          ASSERT_EQ(groups->places()[groups->indices().of(number)], number % kClusterTriangles);
        }
      }
      ASSERT_EQ(groups->places().size(), expected.size());
      ASSERT_EQ(shown, expected_shown);
    }
  });
}

}  // namespace
}  // namespace delray::raster
