// A spot of one depth is a key and a bit for each pixel of its window: a row of it is one vector of
// keys, of which the lesser stay. Degenerate: rows without a covered pixel change nothing.
#include "raster/pipeline/window_spots.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/window_spots.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void rasterize_spots(const WindowSpots& spots, std::span<const std::uint32_t> which,
                     VisibilityTile& tile) {
  const HWY_CAPPED(std::int64_t, WindowSpots::kWindow) d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const auto bit_of_lane = hn::Shl(hn::Set(d, 1), hn::Iota(d, 0));
  // Hardly any that is hidden is known to be: to look costs more than to draw.
  std::uint32_t touched = 0;
  const auto draw = [&](std::uint32_t k) HWY_ATTR {
    const std::uint32_t place = spots.place[k];
    const auto i0 = static_cast<int>(place & 63), j0 = static_cast<int>(place >> 6 & 63);
    const auto rows = static_cast<int>(place >> 12);
    const auto key =
        hn::Set(d, static_cast<std::int64_t>(std::uint64_t{spots.code[k]} << 32 | spots.number[k]));
    std::uint64_t covered = std::uint64_t{spots.lower[k]} << 32 | spots.upper[k];
    std::int64_t* keys = tile.key + j0 * kTileSize + i0;
    for (int j = 0; j < rows; ++j, keys += kTileSize, covered >>= WindowSpots::kWindow) {
      for (std::uint32_t i = 0; i < WindowSpots::kWindow; i += lanes) {
        const auto bits = hn::Set(d, static_cast<std::int64_t>(covered >> i));
        const auto old = hn::LoadU(d, keys + i);
        const auto mask = hn::TestBit(bits, bit_of_lane);
        hn::StoreU(hn::IfThenElse(mask, hn::Min(old, key), old), d, keys + i);
      }
    }
    touched |= blocks_touched(i0, i0 + WindowSpots::kWindow, j0, j0 + rows);
  };
  // Neighbours in the list mostly overlap, and what was stored across two vectors cannot be loaded
  // before it has reached the cache: others are drawn in between.
  constexpr std::size_t kStreams = 8;
  const std::size_t apart = (which.size() + kStreams - 1) / kStreams;
  for (std::size_t first = 0; first < apart; ++first)
    for (std::size_t at = first; at < which.size(); at += apart) draw(which[at]);
  note_drawn(touched, which.size(), tile);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(rasterize_spots);

void rasterize_spots(const WindowSpots& spots, std::span<const std::uint32_t> which,
                     VisibilityTile& tile) {
  HWY_DYNAMIC_DISPATCH(rasterize_spots)(spots, which, tile);
}

}  // namespace delray::raster
#endif
