// Rasters of natural-neighbour heights, tile by tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/terrain_raster.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// A triangle that cells wait with for what lies beyond it.
struct WaitingTriangle {
  std::array<RowPoint, 3> corners;  // counterclockwise
  std::uint32_t met = 0;        // bit k: what lies beyond the edge opposite to corner k has come
  std::uint32_t has_cells = 0;  // whether cells within it wait
};

// Takes the triangles of a triangulation over x and y with z as heights, in any pieces and order,
// and sets every cell of a raster whose centre lies in one to the weighted mean of its natural
// neighbours' heights (Sibson 1981; interpolate.h): to the bit what
// interpolate_natural_neighbour() gives for the whole, as a float.
//
// The neighbours of a centre are the corners of the triangles whose circumcircles hold it, which
// are connected with the one that it is in. Where none of these has an edge at the border of its
// piece they are all there, and the cell is done. Other cells wait, with those triangles, and with
// those of all cells in the same triangle. And with them wait the triangles whose circles reach
// over the border: a centre beyond that is in such a circle sees the triangle through an edge of
// the border, as circles are convex, and so that edge meets the circle, too, and those of all
// triangles on the way there. As soon as they have become twice as many, all that wait are looked
// at as one piece: what has met all of its neighbours is done. So what waits are the borders of
// what has come, and the hull, whose edges in the end are all that have met nothing.
//
// Memory: 100 bytes for each that waits, twice. O(triangles + k log k for each cell of k such
// triangles). Throws FileError (device).
class NaturalNeighbourRaster : public TileSink {
 public:
  // Sets cells of `raster`, which must outlive it.
  explicit NaturalNeighbourRaster(TerrainRaster& raster) : raster_(raster) {}

  void take(const TilePiece& piece) override;

  // What waits, which another raster of the same triangulation may have instead. Not while others
  // take().
  std::vector<WaitingTriangle> give_waiting();
  void add_waiting(std::span<const WaitingTriangle> waiting);

  // Sets all cells that wait, as everything has come.
  void finish();

 private:
  void settle(std::vector<WaitingTriangle> waiting, bool is_all);

  TerrainRaster& raster_;
  std::mutex mutex_;
  std::vector<WaitingTriangle> waiting_;
  std::size_t most_waiting_ = 1 << 16;
};

// The same for a triangulation in memory. In parallel; the result does not depend on the number of
// threads nor on the order of the triangles. O(n + cells).
void fill_natural_neighbours(PointView<double> points, const Triangulation& triangulation,
                             TerrainRaster& raster);

}  // namespace delray::delaunay
