// A triangulation in memory, given piece by piece as one of tiles would be.
#pragma once

#include <cstdint>

#include "delaunay/points.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Gives every simplex once. A piece has those of a compact region, at most `most` of them, as a
// tile of its own: numbers from 0, by a curve through space. Pieces are given by several threads of
// the caller's arena at a time; which there are does not depend on these. O(n), with 6 bytes for a
// simplex and what the pieces in the making take.
//
// What the sink throws is thrown here. REQUIRES: vertices are rows of `points`; most >= 1.
void give_pieces(PointView<double> points, const Triangulation& triangulation, std::uint64_t most,
                 TileSink& sink);

// As above, but in the order of the triangulation, and each piece has all points: 32 bytes for
// each. For sinks that make nothing of points but corners. O(n).
void give_runs(PointView<double> points, const Triangulation& triangulation, std::uint64_t most,
               TileSink& sink);

// As many simplices as a piece of a folder has: tables in the making stay in the cache.
inline constexpr std::uint64_t kSimplicesOfPiece = std::uint64_t{1} << 18;

}  // namespace delray::delaunay
