#include "raytrace/tiles.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

namespace delray::raytrace {
namespace {

TEST(Tiles, CoverTheFrameOnce) {
  for (const auto& [width, height] :
       {std::pair{0, 0}, {1, 1}, {31, 33}, {32, 64}, {200, 7}, {129, 97}}) {
    std::vector<int> covered(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    for (const geometry::Rect& tile : tiles(width, height)) {
      EXPECT_EQ(tile.x0 % 4, 0);
      EXPECT_EQ(tile.y0 % 4, 0);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ++covered[y * width + x];
      }
    }
    for (const int c : covered) EXPECT_EQ(c, 1);
  }
}

TEST(Tiles, EverySchedulerGivesEachTileToOneRank) {
  for (const Schedule& schedule : schedules()) {
    for (int ranks = 1; ranks <= 9; ++ranks) {
      const std::size_t count = tiles(300, 170).size();
      std::vector<int> owners(count, 0);
      for (int rank = 0; rank < ranks; ++rank) {
        for (const std::uint32_t t : tiles_of_rank(schedule, 300, 170, rank, ranks)) {
          ASSERT_LT(t, count);
          ++owners[t];
        }
      }
      for (const int c : owners) EXPECT_EQ(c, 1) << schedule.name << " " << ranks;
    }
  }
}

TEST(Tiles, UnknownScheduleNamesTheLegalOnes) {
  try {
    schedule("nonsense");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("interlaced"), std::string::npos);
  }
}

}  // namespace
}  // namespace delray::raytrace
