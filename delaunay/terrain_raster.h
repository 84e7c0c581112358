// Terrains as grids of heights (DTM): the surface of a triangulation over the plane at the centre
// of every cell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>

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

}  // namespace delray::delaunay
