#include "raster/pipeline/frame_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace delray::raster {
namespace {

// A screen of a few tiles, not all of them wanted nor all drawn in, whose blocks are at random
// distances.
class Blocks {
 public:
  static constexpr int kAcross = 3 * VisibilityTile::kBlocksX;
  static constexpr int kDown = 2 * VisibilityTile::kBlocks / VisibilityTile::kBlocksX;

  explicit Blocks(unsigned seed) : random_(seed) {
    const geometry::Rect clip{0, 0, 2 * kTileSize, 2 * kTileSize};
    tiles_.begin(screen_, make_tile_jobs(screen_, {&clip, 1}));
    for (const int tile : {0, 3, 4}) {
      VisibilityTile& open = tiles_.open(tile);
      for (int block = 0; block < VisibilityTile::kBlocks; ++block)
        open.set_farthest(block, code_of_depth(-1.0F / static_cast<float>(1 + random_() % 100)));
    }
  }

  const FrameTiles& tiles() const { return tiles_; }
  std::int32_t farthest(int x, int y) {
    constexpr int kTileDown = VisibilityTile::kBlocks / VisibilityTile::kBlocksX;
    const int tile = y / kTileDown * 3 + x / VisibilityTile::kBlocksX;
    if (!tiles_.is_wanted(tile)) return 0;
    if (!tiles_.is_drawn_in(tile)) return kEmptyCode;
    return tiles_.open(tile).farthest_of(y % kTileDown * VisibilityTile::kBlocksX +
                                         x % VisibilityTile::kBlocksX);
  }

 private:
  Screen screen_ = make_screen(scenes::make_view({}, 3 * kTileSize, 2 * kTileSize));
  std::mt19937 random_;
  FrameTiles tiles_;
};

TEST(FrameTiles, TellHowFarBlocksAroundAreAtMost) {
  Blocks blocks(8);
  std::mt19937 random(9);
  const auto around = std::make_unique<DepthsAround>();
  int hiding = 0;
  for (int round = 0; round < 500; ++round) {
    const int x0 = static_cast<int>(random() % (3 * kTileSize));
    const int y0 = static_cast<int>(random() % (2 * kTileSize));
    const geometry::Rect pixels{x0, y0, x0 + 1 + static_cast<int>(random() % (3 * kTileSize - x0)),
                                y0 + 1 + static_cast<int>(random() % (2 * kTileSize - y0))};
    const float depth = -1.0F / static_cast<float>(1 + random() % 300);
    const int bx1 = (pixels.x1 - 1) / VisibilityTile::kBlockWidth;
    const int by1 = (pixels.y1 - 1) / VisibilityTile::kBlockHeight;
    const int bx0 = x0 / VisibilityTile::kBlockWidth, by0 = y0 / VisibilityTile::kBlockHeight;
    blocks.tiles().look_around(pixels, depth, *around);
    bool any_nearer = false;
    for (int y = by0; y <= by1; ++y)
      for (int x = bx0; x <= bx1; ++x) any_nearer |= blocks.farthest(x, y) < code_of_depth(depth);
    ASSERT_EQ(around->may_hide, any_nearer);
    if (!any_nearer) continue;
    ++hiding;
    for (int y = by0; y <= by1; ++y) {
      for (int x = bx0; x <= bx1; ++x) {
        std::int32_t expected = 0;
        for (int j = y; j <= std::min(y + 1, by1); ++j) {
          for (int i = x; i <= std::min(x + 1, bx1); ++i)
            expected = std::max(expected, blocks.farthest(i, j));
        }
        ASSERT_EQ(around->farthest[(y - around->y0) * around->width + x - around->x0], expected);
      }
    }
  }
  EXPECT_GT(hiding, 50);
}

TEST(FrameTiles, DoNotLookAroundFar) {
  const Screen screen = make_screen(scenes::make_view({}, 1024, 1024));
  FrameTiles tiles;
  const geometry::Rect all = screen.frame();
  tiles.begin(screen, make_tile_jobs(screen, {&all, 1}));
  for (int tile = 0; tile < screen.tiles(); ++tile) {
    for (int block = 0; block < VisibilityTile::kBlocks; ++block)
      tiles.open(tile).set_farthest(block, 1);
  }
  const auto around = std::make_unique<DepthsAround>();
  tiles.look_around({0, 0, 200, 100}, -0.5F, *around);
  EXPECT_TRUE(around->may_hide);
  for (const geometry::Rect& pixels : {all, geometry::Rect{0, 0, 1024, 200}, geometry::Rect{}}) {
    tiles.look_around(pixels, -0.5F, *around);
    EXPECT_FALSE(around->may_hide);
  }
}

}  // namespace
}  // namespace delray::raster
