// Terrains as grids of heights (DTM): the surface of a triangulation over the plane at the centre
// of every cell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/tile_sink.h"
#include "delaunay/triangulation.h"
#include "geometry/box.h"

namespace delray::delaunay {

// Square cells, rows from north to south.
struct RasterGrid {
  double west = 0, north = 0;  // of the outer corner of cell (0, 0)
  double cell = 1;             // side of a cell, > 0
  std::uint64_t columns = 0, rows = 0;

  double x(std::uint64_t column) const { return west + (static_cast<double>(column) + 0.5) * cell; }
  double y(std::uint64_t row) const { return north - (static_cast<double>(row) + 0.5) * cell; }
};

// The grid whose lines are multiples of the cell size and that covers a box, which is not empty.
// Throws std::invalid_argument for one that a GeoTIFF cannot be (more than 2^31 - 1 cells a side),
// and for cells that coordinates in doubles do not tell apart.
RasterGrid raster_grid(const geometry::Box3d& box, double cell);
// The grid that begins in the north-west corner of a box and covers it. Throws likewise.
RasterGrid raster_grid_within(const geometry::Box3d& box, double cell);

// A cell and its height.
struct CellHeight {
  std::uint64_t column, row;
  float height;
};

// Where the cells of a raster are kept.
struct TerrainRasterOptions {
  std::uint64_t memory = std::uint64_t{256} << 20;  // bytes of blocks that are in memory
  std::filesystem::path scratch;  // a folder for those that are not; empty: that of the system
};

// Takes triangles over x and y with z as heights, and keeps the height of the surface at the centre
// of every cell that lies in one, its border included. A centre on an edge has the height that its
// two ends give, one at a vertex that of the vertex, and one within a triangle that of the three
// corners from the lexicographically lowest on: which triangles come, in which pieces, how often
// and in which order does not show in a single bit.
//
// Blocks of cells go to a scratch file, which has no name, where they do not fit `memory`. Whether
// a centre is in a triangle is decided exactly.
class TerrainRaster : public TileSink {
 public:
  static constexpr std::uint64_t kBlock = 256;  // cells a side, as tiles of the GeoTIFF

  explicit TerrainRaster(const RasterGrid& grid, const TerrainRasterOptions& options = {});
  ~TerrainRaster() override;

  const RasterGrid& grid() const;
  // O(triangles + cells in them). Throws FileError (device). REQUIRES: piece.dim is 2.
  void take(const TilePiece& piece) override;
  // Sets the heights of some cells, best of those that lie near each other. Any thread.
  void set(std::span<const CellHeight> cells);

  // Calls f(block, its cells, NaN for those without a height) for blocks that have been touched,
  // and takes such cells of another raster over the same grid. Not while others take().
  void for_blocks(
      const std::function<void(std::uint64_t block, std::span<const float> cells)>& f) const;
  void merge(std::uint64_t block, std::span<const float> cells);

  std::uint64_t block_columns() const;
  std::uint64_t block_rows() const;
  // The kBlock * kBlock cells of a block, row by row; `no_data` where there is no surface, and
  // beyond the grid. No height equals `no_data`: one that would becomes the next lower float.
  // Returns how many cells have heights. Not while others take().
  std::uint64_t read_block(std::uint64_t block_column, std::uint64_t block_row, float no_data,
                           std::span<float> cells) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

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
