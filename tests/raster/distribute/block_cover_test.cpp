#include "raster/distribute/block_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace delray::raster {
namespace {

constexpr int kWidth = VisibilityTile::kBlockWidth, kHeight = VisibilityTile::kBlockHeight;

std::int64_t& key_at(VisibilityTile& tile, int block, int i, int j) {
  return tile.key[(block / VisibilityTile::kBlocksX * kHeight + j) * kTileSize +
                  block % VisibilityTile::kBlocksX * kWidth + i];
}

bool hides(const BlockCover& cover, std::int32_t code, int i, int j) {
  const int part = j / BlockCover::kPart * BlockCover::kPartsX + i / BlockCover::kPart;
  return code > cover.farthest && (cover.parts >> part & 1) != 0;
}

// Blocks of which more or less is empty, at distances that differ more or less.
class RandomTile {
 public:
  explicit RandomTile(unsigned seed) : random_(seed), tile_(new VisibilityTile) {
    tile_->clear({0, 0, kTileSize, kTileSize});
    for (int block = 0; block < VisibilityTile::kBlocks; ++block) {
      const std::uint32_t empty = random_() % 3, spread = 1 + random_() % 50, at = random_() % 20;
      for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
          if (empty == 1 ? i + 2 * j > 20 : empty == 2 && random_() % 8 == 0) continue;
          key_at(*tile_, block, i, j) =
              key_of(-1.0F / static_cast<float>(1 + at + random_() % spread), random_() % 1000);
        }
      }
    }
    tile_->came_nearer(0xFFFFFFFFU);
  }

  VisibilityTile& operator*() { return *tile_; }
  std::int32_t code(int block, int i, int j) {
    return static_cast<std::int32_t>(key_at(*tile_, block, i, j) >> 32);
  }

 private:
  std::mt19937 random_;
  std::unique_ptr<VisibilityTile> tile_;
};

TEST(BlockCover, HasThePartsThatAreCoveredAndTheFarthestOfAll) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTile tile(seed);
    for (int block = 0; block < VisibilityTile::kBlocks; ++block) {
      BlockCover expected{0, BlockCover::kWhole};
      for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
          const std::int32_t code = tile.code(block, i, j);
          if (code != kEmptyCode) {
            expected.farthest = std::max(expected.farthest, code);
          } else {
            expected.parts &= ~(1U << (j / 2 * (kWidth / 2) + i / 2));
          }
        }
      }
      ASSERT_EQ(cover_of(*tile, block), expected) << "seed " << seed << ", block " << block;
    }
  }
}

TEST(BlockCover, TakesWhatIsKnownOfAWholeBlock) {
  RandomTile tile(1);
  (*tile).stale = 0;
  (*tile).set_farthest(3, 17);
  EXPECT_EQ(cover_of(*tile, 3), (BlockCover{17, BlockCover::kWhole}));
}

TEST(BlockCover, IsEmptyWhereNothingIsDrawn) {
  const auto tile = std::make_unique<VisibilityTile>();
  tile->clear({0, 0, kTileSize, kTileSize});
  EXPECT_EQ(cover_of(*tile, 0), (BlockCover{0, 0}));
  // What is outside of the frame is covered.
  tile->clear({0, 0, 6, kTileSize});
  EXPECT_EQ(cover_of(*tile, 0), (BlockCover{0, 0xF8F8F8F8U}));
  EXPECT_EQ(cover_of(*tile, 1), (BlockCover{0, BlockCover::kWhole}));
}

TEST(BlockCover, DropsWhatItHides) {
  std::uint64_t hidden = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTile other(seed), mine(1000 + seed), before(1000 + seed);
    for (int block = 0; block < VisibilityTile::kBlocks; ++block) {
      const BlockCover cover = cover_of(*other, block);
      bool any = false;
      for (int j = 0; j < kHeight; ++j) {
        float depths[kWidth];
        std::uint32_t expected = 0;
        for (int i = 0; i < kWidth; ++i) {
          const std::int32_t code = before.code(block, i, j);
          depths[i] = depth_of(std::int64_t{code} << 32);
          if (code != kEmptyCode && hides(cover, code, i, j)) expected |= 1U << i;
        }
        ASSERT_EQ(hidden_in_row(cover, j, depths), expected) << "seed " << seed;
        any |= expected != 0;
      }
      ASSERT_EQ(drop_hidden(cover, block, *mine), any) << "seed " << seed << ", block " << block;
      for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
          const bool drops = hides(cover, before.code(block, i, j), i, j);
          hidden += drops;
          ASSERT_EQ(key_at(*mine, block, i, j), drops ? kEmptyKey : key_at(*before, block, i, j));
        }
      }
    }
  }
  EXPECT_GT(hidden, 10000);
}

TEST(BlockCover, DropsNothingThatIsKnownToBeNearer) {
  RandomTile tile(2);
  const BlockCover cover{0, BlockCover::kWhole};
  (*tile).stale = 0;
  (*tile).set_farthest(0, 0);
  EXPECT_FALSE(drop_hidden(cover, 0, *tile));
  (*tile).set_farthest(0, 1);
  EXPECT_TRUE(drop_hidden(cover, 0, *tile));
  EXPECT_FALSE(drop_hidden(BlockCover(), 1, *tile));
}

TEST(BlockCover, MergedHidesWhatOneOfBothHides) {
  std::mt19937 random(5);
  for (int round = 0; round < 20000; ++round) {
    const auto cover = [&] {
      const std::uint32_t kind = random() % 4, parts = random() | random();
      return BlockCover{static_cast<std::int32_t>(random() % 5), kind == 0   ? 0
                                                                 : kind == 1 ? BlockCover::kWhole
                                                                             : parts};
    };
    const BlockCover a = cover(), b = cover(), both = merged(a, b);
    ASSERT_EQ(both, merged(b, a));
    for (std::int32_t code = 0; code < 6; ++code) {
      bool all_of_a = true, all_of_b = true;
      std::uint32_t hidden = 0;
      for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
          const bool by_a = hides(a, code, i, j), by_b = hides(b, code, i, j);
          all_of_a &= by_a;
          all_of_b &= by_b;
          hidden += hides(both, code, i, j);
          ASSERT_TRUE(by_a || by_b || !hides(both, code, i, j));
        }
      }
      if (all_of_a || all_of_b) {
        ASSERT_EQ(hidden, kWidth * kHeight);
      }
    }
    ASSERT_EQ(merged(both, a), both);
  }
}

TEST(BlockCover, OfAllTilesKnowsNothingOfThoseThatAreDrawnInPart) {
  const Screen screen = make_screen(scenes::make_view({}, 2 * kTileSize, 2 * kTileSize));
  FrameTiles tiles;
  const geometry::Rect clip{0, 0, 2 * kTileSize, kTileSize + 8};
  tiles.begin(screen, make_tile_jobs(screen, {&clip, 1}));
  for (const int tile : {1, 2}) {
    VisibilityTile& open = tiles.open(tile);
    for (int block = 0; block < VisibilityTile::kBlocks; ++block) open.set_farthest(block, 7);
  }
  const std::vector<BlockCover> covers = covers_of(tiles, screen);
  ASSERT_EQ(covers.size(), 4U * VisibilityTile::kBlocks);
  for (std::size_t i = 0; i < covers.size(); ++i) {
    ASSERT_EQ(covers[i],
              i / VisibilityTile::kBlocks == 1 ? (BlockCover{7, BlockCover::kWhole}) : BlockCover())
        << i;
  }
}

}  // namespace
}  // namespace delray::raster
