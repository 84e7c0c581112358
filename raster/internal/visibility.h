// Which primitive is seen at each pixel of a tile.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "raster/internal/tile_triangle.h"

namespace delray::raster {

// No primitive has this number.
inline constexpr std::uint32_t kNothing = 0xFFFFFFFFU;

// Depth and primitive number of a tile's pixels; pixel (i, j) of the tile is element
// j * kTileSize + i. The tile is cut into blocks of which the farthest depth is known, at least an
// upper bound of it, so that what lies behind is rejected early (Greene et al. 1993).
struct VisibilityTile {
  static constexpr int kBlockWidth = 16, kBlockHeight = 8;
  static constexpr int kBlocksX = kTileSize / kBlockWidth;
  static constexpr int kBlocks = kTilePixels / (kBlockWidth * kBlockHeight);

  alignas(64) float depth[kTilePixels];
  alignas(64) std::uint32_t number[kTilePixels];
  alignas(64) float farthest[kBlocks];
  std::uint32_t stale = 0;  // bit k: pixels of block k came nearer since farthest[k] was computed
  int since_refresh = 0;    // small triangles drawn since

  // Nothing is seen in `rect` (pixels of the frame, within the tile). Outside it nothing ever will
  // be: the depths there are before all others, so that they do not spoil the farthest ones.
  void clear(const geometry::Rect& rect);
};

// Leaves at every pixel of `rect` the least (depth, number) of what was there and of the triangles
// that `entries` name (Bin::of_tile) and that cover its centre. Masked entries are passed over.
// The order of triangles makes no difference. `rect` is in pixels of the frame, within the tile.
void rasterize(const Screen& screen, const geometry::Rect& rect,
               std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
               VisibilityTile& tile);

// The same for masked entries alone: a pixel counts as covered if solid(number, x, y) says so.
void rasterize_masked(const Screen& screen, const geometry::Rect& rect,
                      std::span<const ScreenTriangle> triangles,
                      std::span<const std::uint32_t> entries,
                      const std::function<bool(std::uint32_t, int, int)>& solid,
                      VisibilityTile& tile);

}  // namespace delray::raster
