// Spots of a few pixels, drawn row by row.
#pragma once

#include "raster/pipeline/visibility.h"

namespace delray::raster {

// Spots of one depth that lie in one tile, within a window of kWindow x kWindow pixels. Grows only.
struct WindowSpots {
  static constexpr int kWindow = 8;

  std::vector<std::uint32_t> place;  // of the first pixel: x | y << 6 | rows << 12
  // Bit 8 * j + i: whether pixel (i, j) of the window is covered; of four rows each.
  std::vector<std::uint32_t> upper, lower;
  std::vector<std::uint32_t> code, number;
  std::vector<std::uint32_t> tile;  // of the frame
  std::size_t size = 0;             // elements that count

  void reserve(std::size_t count) {
    if (place.size() >= count) return;
    for (std::vector<std::uint32_t>* values : {&place, &upper, &lower, &code, &number, &tile})
      values->resize(2 * count);
  }
};

// Leaves at every pixel of the tile the least (depth, number) of what was there and of the spots
// that `which` names; all of them lie in the tile.
void rasterize_spots(const WindowSpots& spots, std::span<const std::uint32_t> which,
                     VisibilityTile& tile);

}  // namespace delray::raster
