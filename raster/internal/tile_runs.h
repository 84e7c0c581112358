// Runs of pixels of a tile that show the same primitive.
#pragma once

#include <cstdint>

#include "raster/internal/visibility.h"

namespace delray::raster {

struct TileRuns {
  static constexpr int kPadding = 16;

  alignas(64) std::uint32_t padded[kPadding + kTilePixels] = {};
  // Bit i of element j: pixel (i, j) shows another one than pixel (i - 1, j), or pixel (i, j - 1).
  // There is always a change at the tile's border.
  std::uint64_t changes_along[kTileSize], changes_down[kTileSize];

  // That each pixel shows.
  std::uint32_t* numbers() { return padded + kPadding; }
  const std::uint32_t* numbers() const { return padded + kPadding; }
};

// Of rows [j0, j1) of the tile; row j0 counts as the border.
void find_runs(const VisibilityTile& tile, int j0, int j1, TileRuns& runs);

}  // namespace delray::raster
