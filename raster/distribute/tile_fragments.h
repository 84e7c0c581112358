// Pixels on their way to the ranks that own them: surfaces seen at single samples, tile by tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comm/buffer.h"
#include "composite/fragment.h"
#include "raster/pipeline/window.h"
#include "raster/shading/tile_view.h"

namespace delray::raster {

// Surfaces seen at samples of a tile. Depths and primitive numbers are the whole scene's, so that
// it makes no difference which rank drew what (kept apart by rank, only the ranks' order would
// decide ties). Those of a sample lie together, front to back, none behind an opaque one.
template <class Payload>
struct TileFragments {
  std::vector<std::uint16_t> positions;  // of fragment i: row-major in the tile
  std::vector<composite::DeepFragment<Payload>> fragments;
};

// The fragments of a tile where they lie, in a message or in TileFragments.
template <class Payload>
struct TileSpan {
  int tile = 0;
  std::span<const std::uint16_t> positions;
  std::span<const composite::DeepFragment<Payload>> fragments;
};
template <class Payload>
TileSpan<Payload> span_of(int tile, const TileFragments<Payload>& seen) {
  return {tile, seen.positions, seen.fragments};
}

// Primitives begin <= i < end of the scene.
struct PrimitiveRange {
  std::uint64_t begin = 0, end = 0;
};

// Appends what the tile shows in `rect`: all surfaces, or the only one at each sample where nothing
// is transparent. Colours that are not transparent travel as the picture stores them. Surfaces of
// primitives that are `passed_over` hide what is behind them, but are left out themselves: the
// receiver has them, too.
//
// REQUIRES: passed_over ascends and is disjoint.
void append_surfaces(TileView& tile, const geometry::Rect& rect,
                     std::span<const PrimitiveRange> passed_over,
                     TileFragments<image::RgbaF>& seen);
template <class Colour>
void append_opaque(TileView& tile, const geometry::Rect& rect,
                   std::span<const PrimitiveRange> passed_over, TileFragments<Colour>& seen);

// As a message: for every tile its number and that of its fragments, the fragments as they are, and
// two bytes for the position of each.
template <class Payload>
comm::Buffer pack_tiles(std::span<const TileSpan<Payload>> tiles);
// The tiles of such a message, which must outlive them.
template <class Payload>
std::vector<TileSpan<Payload>> unpack_tiles(const comm::Buffer& message);

// Colours and depths of the samples of `rect` from what several ranks saw in its tile, in whatever
// order: all surfaces blended once by (depth, primitive), as composite::blend does, or the first of
// them. Samples that nobody saw anything at become empty. O(samples + fragments).
template <class Colour>
void blend_surfaces(std::span<const TileSpan<image::RgbaF>> seen, const geometry::Rect& rect,
                    const Window<Colour>& window);
template <class Colour>
void keep_nearest(std::span<const TileSpan<Colour>> seen, const geometry::Rect& rect,
                  const Window<Colour>& window);

// The same where this rank's own colours and depths are in the window already: what others saw
// takes their place where it is nearer, or as near and of a lower primitive. numbers[y * kTileSize
// + x] is the list's triangle that this rank shows at a position of the tile, or kNothing.
template <class Colour>
void merge_nearest(std::span<const TileSpan<Colour>> arrived, const geometry::Rect& rect,
                   const DrawList& list, std::span<const std::uint32_t> numbers,
                   const Window<Colour>& window);

}  // namespace delray::raster
