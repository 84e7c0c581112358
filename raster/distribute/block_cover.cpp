// Finds and uses covers by vectors of pixels, two rows of them at a time.
//
// Degenerate: tiles at the frame's edge have pixels outside of it that are before all others; they
// count as covered.
#include "raster/distribute/block_cover.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "parallel/parallel_for.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/distribute/block_cover.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Keys = HWY_CAPPED(std::int64_t, 8);

constexpr int kWidth = VisibilityTile::kBlockWidth, kHeight = VisibilityTile::kBlockHeight;
static_assert(BlockCover::kPart == 2 && kWidth * kHeight == 128);

// A bit for each pair of bits, from the lowest on, and back.
constexpr std::uint64_t kPairs = 0x5555555555555555U;
constexpr std::pair<int, std::uint64_t> kSteps[] = {{1, 0x3333333333333333U},
                                                    {2, 0x0F0F0F0F0F0F0F0FU},
                                                    {4, 0x00FF00FF00FF00FFU},
                                                    {8, 0x0000FFFF0000FFFFU},
                                                    {16, 0x00000000FFFFFFFFU}};
std::uint32_t both_of_pairs(std::uint64_t bits) {
  std::uint64_t x = bits & bits >> 1 & kPairs;
  for (const auto& [shift, mask] : kSteps) x = (x | x >> shift) & mask;
  return static_cast<std::uint32_t>(x);
}
std::uint64_t pairs_of(std::uint32_t bits) {
  std::uint64_t x = bits;
  for (std::size_t k = std::size(kSteps); k-- > 0;)
    x = (x | x << kSteps[k].first) & (k > 0 ? kSteps[k - 1].second : kPairs);
  return x | x << 1;
}

BlockCover cover_of(const VisibilityTile& tile, int block) {
  const Keys d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::int64_t* const keys = tile.key + VisibilityTile::first_pixel(block);
  const auto empty = hn::Set(d, kEmptyKey);
  auto farthest = hn::Zero(d);
  std::uint64_t covered = 0;
  for (int j = 0; j < kHeight; j += 2) {
    for (int i = 0; i < kWidth; i += lanes) {
      const std::int64_t* const at = keys + j * kTileSize + i;
      const auto a = hn::Load(d, at), b = hn::Load(d, at + kTileSize);
      const auto in_a = hn::Lt(a, empty), in_b = hn::Lt(b, empty);
      farthest =
          hn::Max(farthest, hn::Max(hn::IfThenElseZero(in_a, a), hn::IfThenElseZero(in_b, b)));
      std::uint8_t some[8] = {};
      hn::StoreMaskBits(d, hn::And(in_a, in_b), some);
      covered |= std::uint64_t{some[0]} << (j / 2 * kWidth + i);
    }
  }
  HWY_ALIGN std::int64_t last[8];
  hn::Store(farthest, d, last);
  return {static_cast<std::int32_t>(*std::max_element(last, last + lanes) >> 32),
          both_of_pairs(covered)};
}

std::uint32_t hidden_in_row(const BlockCover& cover, int row, const float* depths) {
  const HWY_CAPPED(std::int32_t, 8) d;
  const hn::Rebind<float, decltype(d)> df;
  const auto farthest = hn::Set(d, cover.farthest);
  std::uint32_t hidden = 0;
  for (int i = 0; i < kWidth; i += static_cast<int>(hn::Lanes(d))) {
    std::uint8_t some[8] = {};
    // The complement of infinity is less than all codes.
    const auto code = hn::Not(hn::BitCast(d, hn::LoadU(df, depths + i)));
    hn::StoreMaskBits(d, hn::Gt(code, farthest), some);
    hidden |= std::uint32_t{some[0]} << i;
  }
  return hidden & static_cast<std::uint32_t>(pairs_of(cover.parts) >> row / 2 * kWidth);
}

bool drop_hidden(const BlockCover& cover, int block, VisibilityTile& tile) {
  const Keys d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::uint64_t covered = pairs_of(cover.parts);
  const auto empty = hn::Set(d, kEmptyKey);
  const auto farthest = hn::Set(d, std::int64_t{cover.farthest} << 32 | kNothing);
  auto dropped = hn::MaskFromVec(hn::Zero(d));
  std::int64_t* const keys = tile.key + VisibilityTile::first_pixel(block);
  for (int j = 0; j < kHeight; ++j) {
    const std::uint64_t row = covered >> j / 2 * kWidth;
    for (int i = 0; i < kWidth; i += lanes) {
      const std::uint8_t some[8] = {static_cast<std::uint8_t>(row >> i)};
      std::int64_t* const at = keys + j * kTileSize + i;
      const auto key = hn::Load(d, at);
      const auto hidden =
          hn::And(hn::And(hn::Gt(key, farthest), hn::LoadMaskBits(d, some)), hn::Lt(key, empty));
      hn::Store(hn::IfThenElse(hidden, empty, key), d, at);
      dropped = hn::Or(dropped, hidden);
    }
  }
  return !hn::AllFalse(d, dropped);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(cover_of);
HWY_EXPORT(drop_hidden);
HWY_EXPORT(hidden_in_row);

BlockCover merged(const BlockCover& a, const BlockCover& b) {
  const auto& [nearer, other] = a.farthest <= b.farthest ? std::tie(a, b) : std::tie(b, a);
  if ((other.parts & ~nearer.parts) == 0) return nearer;
  return {other.farthest, a.parts | b.parts};
}

BlockCover cover_of(const VisibilityTile& tile, int block) {
  const std::int32_t farthest = tile.farthest_of(block);
  if ((tile.stale >> block & 1) == 0 && farthest != kEmptyCode)
    return {farthest, BlockCover::kWhole};
  return HWY_DYNAMIC_DISPATCH(cover_of)(tile, block);
}

std::vector<BlockCover> covers_of(FrameTiles& tiles, const Screen& screen) {
  constexpr std::size_t kBlocks = VisibilityTile::kBlocks, kGrain = 16;  // tiles
  const auto size = static_cast<std::size_t>(screen.tiles());
  std::vector<BlockCover> covers(size * kBlocks);
  parallel::parallel_for(0, size, kGrain, [&](std::size_t i) {
    const auto index = static_cast<int>(i);
    if (!tiles.is_drawn_in(index) || tiles.rect(index) != screen.tile(index)) return;
    const VisibilityTile& tile = tiles.open(index);
    for (int block = 0; block < VisibilityTile::kBlocks; ++block)
      covers[i * kBlocks + static_cast<std::size_t>(block)] = cover_of(tile, block);
  });
  return covers;
}

bool drop_hidden(const BlockCover& cover, int block, VisibilityTile& tile) {
  const bool is_known = (tile.stale >> block & 1) == 0;
  return cover.may_hide(is_known ? tile.farthest_of(block) : kEmptyCode) &&
         HWY_DYNAMIC_DISPATCH(drop_hidden)(cover, block, tile);
}

std::uint32_t hidden_in_row(const BlockCover& cover, int row, const float* depths) {
  return HWY_DYNAMIC_DISPATCH(hidden_in_row)(cover, row, depths);
}

}  // namespace delray::raster
#endif
