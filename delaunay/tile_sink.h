// Where the simplices of a tiled triangulation go, piece by piece, as soon as they are final.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "delaunay/tiles.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Final simplices of one tile. A tile comes in one piece or in several.
struct TilePiece {
  int dim = 2;
  std::uint64_t tile = 0;
  // Every point that a simplex of the piece has as a corner, once, and maybe others.
  std::span<const RowPoint> points;
  // dim + 1 corners a simplex, as indices into `points`, positively oriented.
  std::span<const std::uint32_t> simplices;
  // Of these simplices, where the giver knows it.
  std::optional<Hash128> hash = std::nullopt;
};

// Writers of mesh folders, rasters, statistics.
class TileSink {
 public:
  virtual ~TileSink() = default;
  // A piece is valid during the call. Any thread, several at a time. Throws what ends the
  // triangulation, such as a files::FileError of a full disk.
  virtual void take(const TilePiece& piece) = 0;
  // Points that have another height than their rows: where places have several (Duplicates). Any
  // thread, a point maybe again.
  virtual void take_heights(std::span<const RowPoint> /*points*/) {}
};

}  // namespace delray::delaunay
