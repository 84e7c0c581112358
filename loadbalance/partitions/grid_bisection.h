// A set of grid cells cut in two so that little crosses the cut.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/costs.h"
#include "loadbalance/partitions/grid_graph.h"
#include "loadbalance/partitions/grid_refinement.h"

namespace delray::loadbalance::internal {

// Cuts in levels (Karypis and Kumar 1998): a set's cells are taken in fours until there are few,
// those are cut, and the cut is refined at its border as the fours are taken apart again.
class GridBisection {
 public:
  explicit GridBisection(const Costs& costs);

  // Names of all cells, row by row.
  std::vector<std::uint32_t> cells() const;
  // The place of a cell in Costs::cells.
  std::size_t place(std::uint32_t cell) const {
    return std::size_t{grid().row(cell)} * columns_ + grid().column(cell);
  }

  // Moves cells that have about `share` of the cost of `cells` to its front and returns how many,
  // at least one and not all; both parts stay in order. Few cells are cut like this: grown from a
  // corner of the set, next the cell that is tied most to those inside and least to those outside
  // (greedy graph growing), or row by row or column by column, each then refined, and of
  // these six the one taken that leaves least crossing. O(cells) where the set is in few pieces.
  // REQUIRES: `cells` are all cells, or what one call left in one of two parts; at least two.
  std::size_t cut(std::span<std::uint32_t> cells, double share);

  // The number of cells visited, for tests.
  std::uint64_t looked_at() const { return looked_at_ + refinement_.looked_at(); }

 private:
  struct Level {
    GridGraph graph;
    std::vector<std::uint32_t> cells;  // of the set; of the finest level empty
  };
  const GridGraph& grid() const { return levels_.front().graph; }
  // Puts cells of a small set inside.
  GridHalf divide(GridGraph& graph, std::span<const std::uint32_t> cells, double wanted);
  // From the seed on, and in the given order, up to the wanted cost.
  void grow(GridGraph& graph, std::span<const std::uint32_t> cells, std::uint32_t seed,
            GridHalf& half);
  void sweep(GridGraph& graph, std::span<const std::uint32_t> order, GridHalf& half);
  // Brings those inside to the front and cuts their ties to the others.
  std::size_t separate(std::span<std::uint32_t> cells);

  std::uint32_t columns_, rows_;
  std::vector<Level> levels_;  // from fine to coarse
  GridRefinement refinement_;
  std::vector<std::uint32_t> near_;  // where refinement looks
  std::vector<std::uint32_t> best_cells_, rest_;
  std::uint64_t looked_at_ = 0;
};

}  // namespace delray::loadbalance::internal
