// Plans of tiles: equal shares, owners first.
#include "raytrace/distributed/tile_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace delray::raytrace {
namespace {

TEST(TilePlan, LastTilesOfALoadedRankGoToOneThatHasLess) {
  const std::vector<PlannedTile> tiles = {{0, 1, 1}, {1, 1, 1}, {2, 0, 1},
                                          {3, 1, 1}, {4, 1, 1}, {6, 1, 1}};
  EXPECT_EQ(plan_tiles(tiles, 7, 2), (std::vector<std::int32_t>{1, 1, 0, 1, 0, kNoPlan, 0}));
}

TEST(TilePlan, StaysWithOwnersWhereSharesAreEqualOrNothingIsKnown) {
  const std::vector<PlannedTile> even = {{0, 1, 2}, {1, 0, 2}}, free = {{0, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(plan_tiles(even, 2, 2), (std::vector<std::int32_t>{1, 0}));
  EXPECT_EQ(plan_tiles(free, 2, 2), (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(plan_tiles({}, 2, 3), (std::vector<std::int32_t>{kNoPlan, kNoPlan}));
}

TEST(TilePlan, LeavesUnevenSharesThatAreTolerated) {
  const std::vector<PlannedTile> tiles = {{0, 1, 1}, {1, 1, 1}, {2, 1, 1}, {3, 0, 1}};
  EXPECT_EQ(plan_tiles(tiles, 4, 2, 0.5), (std::vector<std::int32_t>{1, 1, 1, 0}));
  EXPECT_EQ(plan_tiles(tiles, 4, 2, 0.4), (std::vector<std::int32_t>{1, 1, 0, 0}));
}

// Shares differ a little from frame to frame, and tiles stay; a little more, or owners elsewhere,
// and they do not.
TEST(TilePlan, KeepsTheRanksOfTheLastFrameWhereTheyDo) {
  std::vector<PlannedTile> tiles;
  for (std::uint32_t i = 0; i < 20; ++i) tiles.push_back({i, 0, 1.0, i % 2 == 0 ? 0 : 1});
  std::vector<std::int32_t> last;
  for (const PlannedTile& tile : tiles) last.push_back(tile.rank);
  EXPECT_EQ(plan_tiles(tiles, 20, 2), last);
  tiles[0].seconds = 1.9;
  EXPECT_EQ(plan_tiles(tiles, 20, 2), last);
  tiles[0].seconds = 9.0;
  EXPECT_NE(plan_tiles(tiles, 20, 2), last);
  tiles[0].seconds = 1.0;
  for (PlannedTile& tile : tiles) tile.owner = 1 - tile.rank;
  EXPECT_NE(plan_tiles(tiles, 20, 2), last);
}

TEST(TilePlan, SharesOfRandomTilesDifferByATileAtMost) {
  std::random_device device;
  const unsigned seed = device();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int round = 0; round < 100; ++round) {
    const int ranks = 1 + round % 9;
    std::vector<PlannedTile> tiles(1 + random() % 2000);
    double most = 0.0;
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
      // Most tiles show what the first rank has.
      const auto owner = static_cast<std::int32_t>(random() % static_cast<unsigned>(ranks));
      tiles[i] = {i, i % 3 == 0 ? owner : 0, 1e-3 * static_cast<double>(random() % 1000)};
      most = std::max(most, tiles[i].seconds);
    }
    const std::vector<std::int32_t> plan =
        plan_tiles(tiles, static_cast<std::uint32_t>(tiles.size()), ranks);
    std::vector<double> loads(static_cast<std::size_t>(ranks));
    for (const PlannedTile& tile : tiles)
      loads.at(static_cast<std::size_t>(plan.at(tile.tile))) += tile.seconds;
    const double share = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
    for (const double load : loads) EXPECT_LE(load, share + ranks * most) << round;
  }
}

}  // namespace
}  // namespace delray::raytrace
