// A triangle sets the cells whose centres it has; blocks are pinned while a piece has triangles in
// them. The largest relative error of where an edge crosses a row is some 2^-50 of its coordinates:
// grids whose cells are not far larger are refused, and so are pieces that lie too far from theirs.
#include "delaunay/terrain_raster.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "delaunay/raster/block_store.h"
#include "delaunay/raster/triangle_cells.h"

namespace delray::delaunay {
namespace {

using internal::BlockStore;
using internal::CellRun;
using internal::HeightTriangle;

constexpr std::size_t kCellsOfBlock = TerrainRaster::kBlock * TerrainRaster::kBlock;
constexpr std::uint64_t kBytesOfBlock = kCellsOfBlock * sizeof(float);

RasterGrid grid_from(double west, double north, const geometry::Box3d& box, double cell) {
  constexpr double kMostCells = 2147483647;  // a side of a GeoTIFF
  constexpr double kFinest = 0x1p-40;        // of the largest coordinate
  const double largest =
      std::max({std::abs(west), std::abs(north), std::abs(box.high.x), std::abs(box.low.y)});
  if (!(cell > largest * kFinest) || !std::isfinite(largest)) {
    throw std::invalid_argument("cells of this size are too small for coordinates up to " +
                                std::to_string(largest));
  }
  // A box that ends at a line of the grid has no cell beyond.
  const double columns = std::max(1.0, std::ceil((box.high.x - west) / cell));
  const double rows = std::max(1.0, std::ceil((north - box.low.y) / cell));
  if (!(columns <= kMostCells) || !(rows <= kMostCells)) {
    throw std::invalid_argument("cells of this size are more than 2147483647 in a row or column");
  }
  return {west, north, cell, static_cast<std::uint64_t>(columns), static_cast<std::uint64_t>(rows)};
}

// Blocks that a thread has triangles in.
class Pins {
 public:
  explicit Pins(BlockStore& store) : store_(store) {}
  BlockStore::Block& get(std::uint64_t block) {
    if (block == last_) return *last_block_;
    constexpr std::size_t kMost = 64;  // 16 MB
    if (pins_.size() >= kMost && !pins_.contains(block)) pins_.clear();
    auto found = pins_.find(block);
    if (found == pins_.end()) found = pins_.emplace(block, store_.pin(block)).first;
    last_ = block;
    last_block_ = found->second.operator->();
    return *last_block_;
  }

 private:
  BlockStore& store_;
  std::unordered_map<std::uint64_t, BlockStore::Pin> pins_;
  std::uint64_t last_ = ~std::uint64_t{0};
  BlockStore::Block* last_block_ = nullptr;
};

}  // namespace

RasterGrid raster_grid(const geometry::Box3d& box, double cell) {
  const double west = std::floor(box.low.x / cell) * cell;
  const double north = std::ceil(box.high.y / cell) * cell;
  return grid_from(west, north, box, cell);
}

RasterGrid raster_grid_within(const geometry::Box3d& box, double cell) {
  return grid_from(box.low.x, box.high.y, box, cell);
}

struct TerrainRaster::State {
  State(const RasterGrid& of, const TerrainRasterOptions& options)
      : grid(of),
        columns((of.columns + kBlock - 1) / kBlock),
        rows((of.rows + kBlock - 1) / kBlock),
        store(columns * rows, kCellsOfBlock, options.memory / kBytesOfBlock, options.scratch) {}

  // Calls f(block, cell in it, column) for the cells of a run.
  template <class F>
  void for_run(Pins& pins, const CellRun& run, F&& f) {
    const std::uint64_t in_column = run.row / kBlock * columns, in_row = run.row % kBlock * kBlock;
    for (std::uint64_t column = run.first; column < run.last;) {
      const std::uint64_t next = std::min(run.last, (column / kBlock + 1) * kBlock);
      BlockStore::Block& block = pins.get(in_column + column / kBlock);
      for (; column < next; ++column) f(block, in_row + column % kBlock, column);
    }
  }

  RasterGrid grid;
  std::uint64_t columns, rows;  // of blocks
  mutable BlockStore store;
};

TerrainRaster::TerrainRaster(const RasterGrid& grid, const TerrainRasterOptions& options)
    : state_(std::make_unique<State>(grid, options)) {}
TerrainRaster::~TerrainRaster() = default;

const RasterGrid& TerrainRaster::grid() const { return state_->grid; }
std::uint64_t TerrainRaster::block_columns() const { return state_->columns; }
std::uint64_t TerrainRaster::block_rows() const { return state_->rows; }

void TerrainRaster::take(const TilePiece& piece) {
  assert(piece.dim == 2);
  const RasterGrid& grid = state_->grid;
  Pins pins(state_->store);
  for (std::size_t i = 0; i < piece.simplices.size(); i += 3) {
    const glm::dvec3 &p = piece.points[piece.simplices[i]].position,
                     &q = piece.points[piece.simplices[i + 1]].position,
                     &r = piece.points[piece.simplices[i + 2]].position;
    if (!internal::may_have_centres(grid, p, q, r)) continue;
    const HeightTriangle triangle({p, q, r});
    internal::for_cells(grid, triangle, [&](const CellRun& run, bool within) {
      const double y = grid.y(run.row);
      state_->for_run(pins, run,
                      [&](BlockStore::Block& block, std::size_t cell, std::uint64_t column) {
                        const glm::dvec2 centre(grid.x(column), y);
                        const bool inner = within && column != run.first && column + 1 != run.last;
                        block.set(cell, static_cast<float>(inner ? triangle.height_within(centre)
                                                                 : triangle.height(centre)));
                      });
    });
  }
}

void TerrainRaster::set(std::span<const CellHeight> cells) {
  Pins pins(state_->store);
  for (const CellHeight& each : cells) {
    state_->for_run(pins, {each.row, each.column, each.column + 1},
                    [&](BlockStore::Block& block, std::size_t cell, std::uint64_t) {
                      block.set(cell, each.height);
                    });
  }
}

void TerrainRaster::for_blocks(
    const std::function<void(std::uint64_t block, std::span<const float> cells)>& f) const {
  for (std::uint64_t block = 0; block < state_->columns * state_->rows; ++block) {
    if (state_->store.has(block)) f(block, state_->store.pin(block)->cells);
  }
}

void TerrainRaster::merge(std::uint64_t block, std::span<const float> cells) {
  assert(cells.size() == kCellsOfBlock);
  const BlockStore::Pin pin = state_->store.pin(block);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!std::isnan(cells[i])) pin->set(i, cells[i]);
  }
}

std::uint64_t TerrainRaster::read_block(std::uint64_t block_column, std::uint64_t block_row,
                                        float no_data, std::span<float> cells) const {
  assert(cells.size() == kCellsOfBlock);
  const std::uint64_t number = block_row * state_->columns + block_column;
  std::ranges::fill(cells, no_data);
  if (!state_->store.has(number)) return 0;
  const BlockStore::Pin block = state_->store.pin(number);
  std::uint64_t filled = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const float height = block->cells[i];
    if (std::isnan(height)) continue;
    ++filled;
    cells[i] =
        height == no_data ? std::nextafter(height, std::numeric_limits<float>::lowest()) : height;
  }
  return filled;
}

}  // namespace delray::delaunay
