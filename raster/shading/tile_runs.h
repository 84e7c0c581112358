// Runs of pixels of a tile that show the same primitive.
#pragma once

#include <cstdint>
#include <span>

#include "raster/pipeline/visibility.h"
#include "raster/shading/tile_groups.h"

namespace delray::raster {

struct TileRuns {
  static constexpr int kPadding = 16;

  alignas(64) std::uint32_t padded[kPadding + kTilePixels] = {};
  // Bit i of element j: pixel (i, j) shows another one than pixel (i - 1, j), or pixel (i, j - 1).
  // There is always a change at the tile's border.
  std::uint64_t changes_along[kTileSize], changes_down[kTileSize];
  std::uint64_t shown[kTileSize];  // bit i of element j: pixel (i, j) shows something

  // The triangle that each pixel shows.
  std::uint32_t* numbers() { return padded + kPadding; }
  const std::uint32_t* numbers() const { return padded + kPadding; }
};

// Finds the runs of rows [j0, j1) of the tile; row j0 counts as the border.
void find_runs(const VisibilityTile& tile, int j0, int j1, TileRuns& runs);

// Pixels [first, first + 64) of a row of a tile, or as many as there are: bit i is pixel first + i.
struct RowRuns {
  std::uint64_t starts;          // it shows another triangle than the one before; bit 0 is set
  std::uint64_t shown;           // it shows a triangle
  const std::uint32_t* numbers;  // what it shows
};
inline RowRuns row_of(const TileRuns& runs, int first, int j) {
  return {runs.changes_along[j] >> first | 1, runs.shown[j] >> first,
          runs.numbers() + j * kTileSize + first};
}

// Adds what columns [i0, i1) of rows [j0, j1) show, whose runs are found, to the groups. Returns
// how many pixels show something.
std::uint64_t add_runs(const TileRuns& runs, int i0, int j0, int i1, int j1, TileGroups& groups);

}  // namespace delray::raster
