// What a rank's drawing may hide of others', in short.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/pipeline/frame_tiles.h"

namespace delray::raster {

// Of a block of a VisibilityTile: at all pixels of these parts of it, kPart by kPart pixels each,
// something is seen that is at most as far as `farthest` (masked occlusion culling: Hasselgren,
// Andersson and Akenine-Moller 2016).
struct BlockCover {
  static constexpr int kPart = 2;
  static constexpr int kPartsX = VisibilityTile::kBlockWidth / kPart;
  static constexpr std::uint32_t kWhole = 0xFFFFFFFFU;
  static_assert(kPartsX * VisibilityTile::kBlockHeight / kPart == 32);

  std::int32_t farthest = kEmptyCode;  // as a code
  std::uint32_t parts = 0;             // bit k: column k % kPartsX of row k / kPartsX

  bool operator==(const BlockCover&) const = default;

  // Whether anything may be hidden of what is at most so far.
  bool may_hide(std::int32_t code) const { return parts != 0 && code > farthest; }
};

// What two drawings of the same block hide together, as far as one cover can tell it: everything
// that either hides as a whole, at least. Commutative; the order in which more are merged may make
// a difference.
BlockCover merged(const BlockCover& a, const BlockCover& b);

// What the tile hides in the block now; nothing that is seen there is farther than its `farthest`.
// O(pixels).
BlockCover cover_of(const VisibilityTile& tile, int block);
// Of all blocks by tile of the screen and block in it; BlockCover() where less than a tile is
// drawn. Parallel.
std::vector<BlockCover> covers_of(FrameTiles& tiles, const Screen& screen);

// Empties the pixels of the block that the cover hides; whether there are any.
bool drop_hidden(const BlockCover& cover, int block, VisibilityTile& tile);
// The bits of those in a row of it of which these are the depths.
std::uint32_t hidden_in_row(const BlockCover& cover, int row, const float* depths);

}  // namespace delray::raster
