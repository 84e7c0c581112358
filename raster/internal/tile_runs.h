// Runs of pixels of a tile that show the same primitive.
#pragma once

#include <cstdint>
#include <span>

#include "raster/internal/tile_groups.h"
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

// Index of a run that shows no triangle, or none that is shaded with the others.
inline constexpr std::uint16_t kNoTriangle = 0xFFFFU;

// The runs' triangles, by index in the tile's groups.
struct RunTriangles {
  std::uint16_t triangle[kTilePixels + 1];  // row by row
  std::uint16_t first[kTileSize];           // of a row
  std::uint64_t starts[kTileSize];          // bit i of a row: a run starts at pixel i
  // For looking them up: groups of those that start with another triangle than the one above.
  std::uint16_t group[kTilePixels + 1];

  std::span<const std::uint16_t> of_row(int j) const {
    return std::span(triangle).subspan(first[j]);
  }
};

// Of columns [i0, i1) of rows [j0, j1), whose runs are found; the groups are filled with what they
// show. Returns how many pixels show something.
std::uint64_t number_runs(const TileRuns& runs, int i0, int j0, int i1, int j1, TileGroups& groups,
                          RunTriangles& result);

}  // namespace delray::raster
