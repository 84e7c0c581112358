// Builds the graph of a cost grid with a margin of absent cells, and coarsens it: parents add up
// the costs of their cells and the ties that leave to the right and downward. Cells without cost
// and edges that nothing crosses get a little of both, so that regions are compact there and such
// cells are cut by their number.
#include "loadbalance/partitions/grid_graph.h"

#include <bit>

namespace delray::loadbalance::internal {
namespace {

// Ties of cells that nothing crosses, over the mean tie.
constexpr double kLeastTie = 1;
// Costs of cells that have none, over the mean cost.
constexpr double kLeastCost = 1e-6;

double sum(std::span<const double> values) {
  double result = 0;
  for (const double value : values) result += value;
  return result;
}

}  // namespace

GridGraph::GridGraph(unsigned log_stride, std::uint32_t rows)
    : log_stride_(log_stride), cells_(std::size_t{rows + kFirstRow + 1} << log_stride) {}

GridGraph::GridGraph(const Costs& grid, unsigned levels)
    : GridGraph(static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(grid.columns) +
                                                     (std::uint32_t{1} << levels) - 1)),
                static_cast<std::uint32_t>(grid.rows)) {
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  const auto rows = static_cast<std::uint32_t>(grid.rows);
  const double count = static_cast<double>(grid.cells.size());
  const double ties = sum(grid.cross_right) + sum(grid.cross_down), total = sum(grid.cells);
  const double tie = ties > 0 ? kLeastTie * ties / (2 * count) : 1;
  const double cost = total > 0 ? kLeastCost * total / count : 1;
  std::size_t k = 0;
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i, ++k) {
      Cell& c = cells_[cell(i, j)];
      c.cost = grid.cells[k] + cost;
      if (i + 1 < columns) c.right = grid.cross_right[k] + tie;
      if (j + 1 < rows) c.down = grid.cross_down[k] + tie;
    }
  }
}

double GridGraph::gain(std::uint32_t cell) const {
  double gain = 0;
  for_each_neighbour(cell, [&](std::uint32_t neighbour, double tie) {
    gain += is_inside(neighbour) == is_inside(cell) ? -tie : tie;
  });
  return gain;
}

bool GridGraph::at_border(std::uint32_t cell) const {
  bool result = false;
  for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
    result = result || is_inside(neighbour) != is_inside(cell);
  });
  return result;
}

void GridGraph::coarsen(std::span<const std::uint32_t> cells, GridGraph& coarse,
                        std::vector<std::uint32_t>& parents) const {
  for (const std::uint32_t parent : parents) coarse.cells_[parent] = {};
  parents.clear();
  for (const std::uint32_t cell : cells) {
    const std::uint32_t parent_cell = parent(cell);
    const Cell& from = cells_[cell];
    Cell& to = coarse.cells_[parent_cell];
    if (!to.marked) {
      to.marked = true;
      parents.push_back(parent_cell);
    }
    to.cost += from.cost;
    if (column(cell) % 2 == 1) to.right += from.right;
    if (row(cell) % 2 == 1) to.down += from.down;
  }
  for (const std::uint32_t parent_cell : parents) coarse.cells_[parent_cell].marked = false;
}

void GridGraph::separate(std::uint32_t cell) {
  Cell& c = cells_[cell];
  if (is_inside(cell + 1) != c.inside) c.right = 0;
  if (is_inside(cell + stride()) != c.inside) c.down = 0;
}

}  // namespace delray::loadbalance::internal
