// Which primitive is seen at each pixel of a tile.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "parallel/function_ref.h"
#include "raster/pipeline/tile_triangle.h"

namespace delray::raster {

// No primitive has this number.
inline constexpr std::uint32_t kNothing = 0xFFFFFFFFU;

// A depth as a whole number, in the same order: depths are negative, so that the complement of
// their bits ascends with them and is positive.
inline std::int32_t code_of_depth(float depth) {
  return static_cast<std::int32_t>(~std::bit_cast<std::uint32_t>(depth));
}

// The surface that is seen at a pixel: depth and number in one word, of which the least wins.
// kEmptyKey is farther than all triangles, and has the upper half kEmptyCode.
inline constexpr std::int32_t kEmptyCode = 0x7F800000;
inline constexpr std::int64_t kEmptyKey = (std::int64_t{kEmptyCode} << 32) | kNothing;
inline std::int64_t key_of(float depth, std::uint32_t number) {
  return (std::int64_t{code_of_depth(depth)} << 32) | number;
}
inline std::uint32_t number_of(std::int64_t key) { return static_cast<std::uint32_t>(key); }
inline float depth_of(std::int64_t key) {
  const auto code = static_cast<std::uint32_t>(key >> 32);
  return code == static_cast<std::uint32_t>(kEmptyCode) ? image::kEmptyDepth
                                                        : std::bit_cast<float>(~code);
}

// A pixel's worth of a small triangle.
struct Fragment {
  std::int64_t key;
  std::uint32_t pixel;  // of the tile
};

// The keys of a tile's pixels; pixel (i, j) of the tile is element j * kTileSize + i. The tile is
// cut into blocks of which the code of the farthest depth is known, at least an upper bound of it,
// so that what lies behind is rejected early (Greene et al. 1993).
//
// One thread at a time may change a tile; others may read `farthest` meanwhile, by farthest_of.
struct VisibilityTile {
  static constexpr int kBlockWidth = 16, kBlockHeight = 8;
  static constexpr int kBlocksX = kTileSize / kBlockWidth;
  static constexpr int kBlocks = kTilePixels / (kBlockWidth * kBlockHeight);
  // The first pixel of a block.
  static constexpr int first_pixel(int block) {
    return block / kBlocksX * kBlockHeight * kTileSize + block % kBlocksX * kBlockWidth;
  }

  alignas(64) std::int64_t key[kTilePixels];
  alignas(64) std::int32_t farthest[kBlocks];
  std::uint32_t stale = 0;    // bit k: pixels of block k came nearer since farthest[k] was computed
  std::uint32_t changed = 0;  // a bit, too: splats may have come nearer; for who clears it
  int since_refresh = 0;      // small triangles and fragments drawn since

  // Nothing is seen in `rect` (pixels of the frame, within the tile). Outside it nothing ever will
  // be: the depths there are before all others, so that they do not spoil the farthest ones.
  void clear(const geometry::Rect& rect);

  // Pixels of these blocks, a bit each, may have come nearer.
  void came_nearer(std::uint32_t blocks) {
    stale |= blocks;
    changed |= blocks;
  }
  // The code of the farthest depth in a block as it is now.
  std::int32_t farthest_now(int block) const;

  std::int32_t farthest_of(int block) const {
    return std::atomic_ref(const_cast<std::int32_t&>(farthest[block]))
        .load(std::memory_order_relaxed);
  }
  void set_farthest(int block, std::int32_t code) {
    std::atomic_ref(farthest[block]).store(code, std::memory_order_relaxed);
  }
};

// Blocks that pixels [i0, i1) x [j0, j1) of the tile touch, a bit each. REQUIRES: at least one and
// at most 2 * kBlockHeight rows.
inline std::uint32_t blocks_touched(int i0, int i1, int j0, int j1) {
  const int bx0 = i0 / VisibilityTile::kBlockWidth, bx1 = (i1 - 1) / VisibilityTile::kBlockWidth;
  const int by0 = j0 / VisibilityTile::kBlockHeight, by1 = (j1 - 1) / VisibilityTile::kBlockHeight;
  const std::uint32_t row = (2U << bx1) - (1U << bx0);
  // At most three rows of blocks; not a loop, which would be unrolled for many.
  const int by = (by0 + by1) / 2;
  const std::uint32_t touched = row << (by0 * VisibilityTile::kBlocksX) |
                                row << (by * VisibilityTile::kBlocksX) |
                                row << (by1 * VisibilityTile::kBlocksX);
  return touched;
}

// For who has drawn `count` small things into blocks of these bits: notes it, and computes farthest
// depths anew once that pays.
void note_drawn(std::uint32_t blocks, std::size_t count, VisibilityTile& tile);

// Triangles of a few pixels that lie in one tile, ready to be drawn: everything that
// tile_triangle.h computes, for the window of pixels from (x, y) of the tile on, x a
// multiple of kWindowWidth. A window is of so many times kRowsAtOnce rows, within the tile, of
// which the first `above` and the last `below` are not the triangle's: how often a loop runs is
// guessed wrong less often then. Four by four, so that vectors of them may be loaded. Grows only.
struct WindowTriangles {
  // Edge functions at the window's first pixel, and what they grow by per column and row.
  struct Edges {
    std::int32_t value[3];
    // x | y << 6 | above << 12 | below << 14 | rows / kRowsAtOnce << 16 | parts << 20, the parts
    // kWindowWidth wide.
    std::uint32_t window;
  };
  struct Columns {
    std::int32_t step[3];
    std::uint32_t number;
  };
  struct Rows {
    std::int32_t step[3];
    std::int32_t unused;
  };
  // Depth as in TileTriangle.
  struct Plane {
    float slope_x, slope_y, x, y;
  };
  struct Depths {
    float depth, nearest, farthest, unused;
  };
  static constexpr int kWindowWidth = 8, kRowsAtOnce = 4;
  static constexpr int kMostRows = 16, kMostColumns = 16;

  std::vector<Edges> edges;
  std::vector<Columns> columns;
  std::vector<Rows> rows;
  std::vector<Plane> planes;
  std::vector<Depths> depths;
  std::vector<std::uint32_t> tile;  // of the frame
  std::size_t size = 0;             // elements that count

  void reserve(std::size_t count) {
    if (edges.size() >= count) return;
    const std::size_t more = 2 * count;
    edges.resize(more);
    columns.resize(more);
    rows.resize(more);
    planes.resize(more);
    depths.resize(more);
    tile.resize(more);
  }
};

// An entry of a tile is the index of a triangle, with kMasked where it has holes in it.
inline constexpr std::uint32_t kMasked = 0x80000000U;
inline constexpr std::uint32_t kIndex = 0x7FFFFFFFU;

// Leaves at every pixel of `rect` the least (depth, number) of what was there and of the triangles
// that `entries` name and that cover its centre. Masked entries are passed over. The order of
// triangles makes no difference. `rect` is in pixels of the frame, within the tile.
void rasterize(const Screen& screen, const geometry::Rect& rect,
               std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
               VisibilityTile& tile);

// As rasterize, of fragments.
void rasterize_fragments(std::span<const Fragment> fragments, VisibilityTile& tile);

// As rasterize, of the windows that `which` names; all of them lie in the tile.
void rasterize_windows(const WindowTriangles& triangles, std::span<const std::uint32_t> which,
                       VisibilityTile& tile);

// Calls f(i, j, key) for every pixel of `rect`, at (i, j) of its tile, whose centre the triangle
// covers.
template <class F>
void for_each_covered(const Screen& screen, const geometry::Rect& rect,
                      const ScreenTriangle& triangle, F&& f) {
  const int tile_x = rect.x0 / kTileSize * kTileSize;
  const int tile_y = rect.y0 / kTileSize * kTileSize;
  const ScreenVertex* v = triangle.vertex;
  const geometry::Rect pixels =
      geometry::intersection(centres_in_box(v[0], v[1], v[2], screen), rect);
  TileTriangle t;
  if (pixels.empty() || !make_tile_triangle(triangle, screen, tile_x, tile_y, t)) return;
  for (int j = pixels.y0 - tile_y; j < pixels.y1 - tile_y; ++j) {
    for (int i = pixels.x0 - tile_x; i < pixels.x1 - tile_x; ++i)
      if (covers(t, i, j)) f(i, j, key_of(depth_at(t, i, j), triangle.number));
  }
}

// As rasterize, of masked entries alone: a pixel counts as covered if alpha_test(number, x, y) says
// so.
void rasterize_masked(const Screen& screen, const geometry::Rect& rect,
                      std::span<const ScreenTriangle> triangles,
                      std::span<const std::uint32_t> entries,
                      parallel::FunctionRef<bool(std::uint32_t, int, int)> alpha_test,
                      VisibilityTile& tile);

// As rasterize, of all entries, masked or not, or of fragments in `rect`'s tile, pixel by pixel:
// shade(number, x, y) is called whenever a pixel comes to show another triangle. Returns how often.
std::uint64_t draw_and_shade(const Screen& screen, const geometry::Rect& rect,
                             std::span<const ScreenTriangle> triangles,
                             std::span<const std::uint32_t> entries,
                             parallel::FunctionRef<bool(std::uint32_t, int, int)> alpha_test,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile);
std::uint64_t draw_and_shade(std::span<const Fragment> fragments, const geometry::Rect& rect,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile);

}  // namespace delray::raster
