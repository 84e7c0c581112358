// Sets of cells of a grid as a graph: cells with costs, and ties between neighbours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/costs.h"

namespace delray::loadbalance::internal {

// Cells are numbered row by row, rows a power of two apart, so that halving a grid is a matter of
// shifts. Every row ends with a cell that does not exist, and rows before and behind the grid do
// not exist: a cell's four neighbours can be looked up without asking where it is.
class GridGraph {
 public:
  // A grid without cells.
  GridGraph(unsigned log_stride, std::uint32_t rows);
  // The whole grid; `levels` is how often it is going to be halved. Cells that nothing crosses are
  // tied a little, so that regions are compact there, and cells without cost get a little, so that
  // sets of them are cut by their number.
  GridGraph(const Costs& costs, unsigned levels);

  unsigned log_stride() const { return log_stride_; }  // of the distance of rows
  std::uint32_t cell(std::uint32_t column, std::uint32_t row) const {
    return ((row + kFirstRow) << log_stride_) + column;
  }
  std::uint32_t column(std::uint32_t cell) const { return cell & (stride() - 1); }
  std::uint32_t row(std::uint32_t cell) const { return (cell >> log_stride_) - kFirstRow; }
  // The cell's number when columns and rows are taken in pairs.
  std::uint32_t parent(std::uint32_t cell) const {
    return (((cell >> (log_stride_ + 1)) + kFirstRow / 2) << (log_stride_ - 1)) |
           (column(cell) / 2);
  }

  double cost(std::uint32_t cell) const { return cells_[cell].cost; }
  bool is_inside(std::uint32_t cell) const { return cells_[cell].inside; }
  void put_inside(std::uint32_t cell, bool inside) { cells_[cell].inside = inside; }
  // For whoever works with the cells.
  bool is_marked(std::uint32_t cell) const { return cells_[cell].marked; }
  void mark(std::uint32_t cell, bool marked) { cells_[cell].marked = marked; }

  // Calls f(neighbour, tie) for the cells that this one is tied to.
  template <class F>
  void for_each_neighbour(std::uint32_t cell, F&& f) const {
    const auto visit = [&](std::uint32_t neighbour, double tie) {
      if (tie > 0) f(neighbour, tie);
    };
    visit(cell - 1, cells_[cell - 1].right);
    visit(cell + 1, cells_[cell].right);
    visit(cell - stride(), cells_[cell - stride()].down);
    visit(cell + stride(), cells_[cell].down);
  }
  // The cost of crossing edges that a cell would save by changing sides.
  double gain(std::uint32_t cell) const;
  // Whether it is tied to a cell on the other side.
  bool at_border(std::uint32_t cell) const;

  // Replaces `coarse`, whose cells are `parents`, by the parents of these cells, each with the cost
  // of those of its four that are among them and with their ties to the next parent.
  // REQUIRES: these cells are tied to each other only. O(cells + parents).
  void coarsen(std::span<const std::uint32_t> cells, GridGraph& coarse,
               std::vector<std::uint32_t>& parents) const;
  // Cuts the cell's ties to the next column and row where those are on the other side.
  void separate(std::uint32_t cell);

 private:
  struct Cell {
    double cost = 0;
    double right = 0, down = 0;  // ties to the next cell; 0 where there is none
    bool inside = false, marked = false;
  };
  std::uint32_t stride() const { return std::uint32_t{1} << log_stride_; }
  static constexpr std::uint32_t kFirstRow = 2;  // even, for parent()

  unsigned log_stride_;
  std::vector<Cell> cells_;
};

}  // namespace delray::loadbalance::internal
