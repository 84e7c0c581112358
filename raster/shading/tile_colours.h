// Colours of plain splats that are looked up as soon as they are seen: for draws whose meshes are
// in memory only while they are drawn.
#pragma once

#include "raster/shading/shade_tile.h"

namespace delray::raster {

// Of a tile's pixels, pixel (i, j) of the tile is element j * kTileSize + i.
struct TileColours {
  std::uint64_t drawing = 0;          // whose they are
  std::uint32_t number[kTilePixels];  // that the colours are of; kNothing: none yet
  image::RgbaF colour[kTilePixels];
};

// Looks up the colours of pixels that have come to show another splat, in blocks that changed,
// which they have not any more then. Colours of another drawing than `drawing` are forgotten
// before.
//
// REQUIRES: frame.all_plain; the meshes of what was drawn since the last call are in memory;
// drawing > 0.
void look_up_colours(const FrameShading& frame, VisibilityTile& tile, std::uint64_t drawing,
                     TileColours& colours);

}  // namespace delray::raster
