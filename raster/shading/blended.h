// Transparent surfaces in front of what a tile shows (Carpenter 1984).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/pipeline/draw_into_tiles.h"

namespace delray::raster {

// A surface at one pixel of a tile.
struct BlendedFragment {
  std::uint32_t pixel;  // row-major in the tile
  std::int64_t key;
};

// The fragments of the tile's blended triangles that lie before what is opaque, by pixel, front to
// back. `tile` may be null where nothing opaque was drawn; `rect` is the part of the tile that is
// wanted. O(pixels of the triangles' boxes + fragments log fragments).
void find_blended(const Screen& screen, const geometry::Rect& rect,
                  std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
                  const VisibilityTile* tile, std::vector<BlendedFragment>& fragments);

}  // namespace delray::raster
