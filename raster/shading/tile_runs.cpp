// Compares each pixel's triangle with the one to the left and the one above, by vectors, and keeps
// the answers as bits. A triangle is added to the groups where a run of it starts that does not
// continue the row above.
#include "raster/shading/tile_runs.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading/tile_runs.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Numbers = HWY_CAPPED(std::uint32_t, 16);
using N = hn::Vec<Numbers>;

HWY_INLINE N numbers_of(const std::int64_t* keys) {
  const Numbers d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, number_of(*keys));
#else
  const hn::Repartition<std::int64_t, Numbers> d64;
  const auto low = hn::Load(d64, keys);
  const auto high = hn::Load(d64, keys + hn::Lanes(d64));
  return hn::ConcatEven(d, hn::BitCast(d, high), hn::BitCast(d, low));
#endif
}

HWY_INLINE std::uint64_t bits(hn::Mask<Numbers> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Numbers(), mask, bytes);
  return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8;
}

void find_runs(const VisibilityTile& tile, int j0, int j1, TileRuns& runs) {
  const Numbers d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::uint32_t* const numbers = runs.numbers();
  for (int pixel = j0 * kTileSize; pixel < j1 * kTileSize; pixel += lanes)
    hn::Store(numbers_of(tile.key + pixel), d, numbers + pixel);
  for (int j = j0; j < j1; ++j) {
    const std::uint32_t* const row = numbers + j * kTileSize;
    const std::uint32_t* const above = j == j0 ? row : row - kTileSize;
    std::uint64_t along = 0, down = 0, shown = 0;
    for (int i = 0; i < kTileSize; i += lanes) {
      const N here = hn::Load(d, row + i);
      along |= bits(hn::Ne(here, hn::LoadU(d, row + i - 1))) << i;
      down |= bits(hn::Ne(here, hn::Load(d, above + i))) << i;
      shown |= bits(hn::Ne(here, hn::Set(d, kNothing))) << i;
    }
    runs.changes_along[j] = along | 1;
    runs.changes_down[j] = j == j0 ? ~std::uint64_t{0} : down;
    runs.shown[j] = shown;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(find_runs);

void find_runs(const VisibilityTile& tile, int j0, int j1, TileRuns& runs) {
  HWY_DYNAMIC_DISPATCH(find_runs)(tile, j0, j1, runs);
}

std::uint64_t add_runs(const TileRuns& runs, int i0, int j0, int i1, int j1, TileGroups& groups) {
  const std::uint64_t clip = (~std::uint64_t{0} >> (kTileSize - (i1 - i0))) << i0;
  std::uint64_t shown = 0;
  for (int j = j0; j < j1; ++j) {
    const std::uint32_t* const numbers = runs.numbers() + j * kTileSize;
    const std::uint64_t here = runs.shown[j] & clip;
    shown += static_cast<std::uint64_t>(std::popcount(here));
    const std::uint64_t starts = runs.changes_along[j] | std::uint64_t{1} << i0;
    for (std::uint64_t rest = starts & runs.changes_down[j] & here; rest != 0; rest &= rest - 1)
      groups.add(numbers[std::countr_zero(rest)]);
  }
  return shown;
}

}  // namespace delray::raster
#endif
