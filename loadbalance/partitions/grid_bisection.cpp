// Multilevel bisection of a set of grid cells (Karypis and Kumar 1998).
//
// Cells are coarsened by fours until few are left. The few are divided in up to six ways, by greedy
// graph growing from the corners of the set and by sweeps along rows and columns, each is refined,
// and the one with the least crossing cost is kept. The cut is projected back level by level and
// refined at its border. O(cells) where the set is in few pieces.
//
// Degenerate: both parts get at least one cell; a set in several pieces is grown piece by piece;
// without costs cells count alike.
#include "loadbalance/partitions/grid_bisection.h"

#include <algorithm>
#include <iterator>
#include <queue>

namespace delray::loadbalance::internal {
namespace {

// As many as can be cut without thinking twice, and enough that cuts are not coarse.
constexpr std::size_t kFewCells = 1024;
// The tolerance of a part's cost, relative to the cost that is wanted; what coarser levels leave
// too much the finest mends, unless its border lies where there is no cost.
constexpr double kTolerance = 0.01, kCoarseTolerance = 0.02;

unsigned levels_of(std::size_t cells) {
  unsigned levels = 0;
  for (; cells > kFewCells; cells /= 4) ++levels;
  return levels;
}

// Puts a cell inside unless the cost would be further from what is wanted; false when no other cell
// should come after it.
bool take(GridGraph& graph, std::uint32_t cell, GridHalf& half) {
  const double with = half.cost + graph.cost(cell);
  if (half.count > 0 && with - half.wanted > half.wanted - half.cost) return false;
  half.crossing -= graph.gain(cell);
  half.cost = with;
  ++half.count;
  graph.put_inside(cell, true);
  return with < half.wanted;
}

}  // namespace

GridBisection::GridBisection(const Costs& costs)
    : columns_(static_cast<std::uint32_t>(costs.columns)),
      rows_(static_cast<std::uint32_t>(costs.rows)) {
  const unsigned levels = levels_of(costs.cells.size());
  levels_.push_back({GridGraph(costs, levels), {}});
  for (unsigned k = 1; k <= levels; ++k) {
    const std::uint32_t rows = (rows_ + (std::uint32_t{1} << k) - 1) >> k;
    levels_.push_back({GridGraph(grid().log_stride() - k, rows), {}});
  }
}

std::vector<std::uint32_t> GridBisection::cells() const {
  std::vector<std::uint32_t> cells;
  cells.reserve(std::size_t{columns_} * rows_);
  for (std::uint32_t j = 0; j < rows_; ++j) {
    for (std::uint32_t i = 0; i < columns_; ++i) cells.push_back(grid().cell(i, j));
  }
  return cells;
}

void GridBisection::grow(GridGraph& graph, std::span<const std::uint32_t> cells, std::uint32_t seed,
                         GridHalf& half) {
  std::priority_queue<GridMove> border;
  border.push({graph.gain(seed), seed});
  std::size_t next = 0;  // where to go on when the set is in several pieces
  while (half.count + 1 < cells.size()) {
    while (!border.empty() && (graph.is_inside(border.top().cell) ||
                               border.top().gain != graph.gain(border.top().cell))) {
      border.pop();  // taken, or pushed again with another gain
    }
    if (border.empty()) {
      while (graph.is_inside(cells[next])) ++next;
      border.push({graph.gain(cells[next]), cells[next]});
    }
    const std::uint32_t cell = border.top().cell;
    border.pop();
    ++looked_at_;
    if (!take(graph, cell, half)) break;
    graph.for_each_neighbour(cell, [&](std::uint32_t neighbour, double) {
      if (!graph.is_inside(neighbour)) border.push({graph.gain(neighbour), neighbour});
    });
  }
}

void GridBisection::sweep(GridGraph& graph, std::span<const std::uint32_t> order, GridHalf& half) {
  for (const std::uint32_t cell : order) {
    if (half.count + 1 == order.size() || !take(graph, cell, half)) break;
    ++looked_at_;
  }
}

GridHalf GridBisection::divide(GridGraph& graph, std::span<const std::uint32_t> cells,
                               double wanted) {
  GridHalf best;
  const auto attempt = [&](auto&& take_cells) {
    for (const std::uint32_t cell : cells) graph.put_inside(cell, false);
    GridHalf half{.wanted = wanted, .tolerance = kCoarseTolerance * wanted};
    looked_at_ += cells.size();
    take_cells(half);
    near_.assign(cells.begin(), cells.end());
    refinement_.refine(graph, near_, cells.size(), half);
    if (best.count > 0 && half.crossing >= best.crossing) return;
    best = half;
    best_cells_.clear();
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(best_cells_),
                 [&](std::uint32_t cell) { return graph.is_inside(cell); });
  };

  std::vector<std::uint32_t> corners;
  for (const int x : {-1, 1}) {
    for (const int y : {-1, 1}) {
      const auto along = [&](std::uint32_t cell) {
        return x * std::int64_t{graph.column(cell)} + y * std::int64_t{graph.row(cell)};
      };
      const auto corner =
          std::max_element(cells.begin(), cells.end(),
                           [&](std::uint32_t i, std::uint32_t j) { return along(i) < along(j); });
      if (std::find(corners.begin(), corners.end(), *corner) == corners.end())
        corners.push_back(*corner);
    }
  }
  for (const std::uint32_t corner : corners)
    attempt([&](GridHalf& half) { grow(graph, cells, corner, half); });

  std::vector<std::uint32_t> order(cells.begin(), cells.end());
  std::sort(order.begin(), order.end());
  attempt([&](GridHalf& half) { sweep(graph, order, half); });
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return graph.column(i) < graph.column(j);
  });
  attempt([&](GridHalf& half) { sweep(graph, order, half); });

  for (const std::uint32_t cell : cells) graph.put_inside(cell, false);
  for (const std::uint32_t cell : best_cells_) graph.put_inside(cell, true);
  return best;
}

std::size_t GridBisection::cut(std::span<std::uint32_t> cells, double share) {
  const auto set = [&](std::size_t level) {
    return level == 0 ? std::span<const std::uint32_t>(cells)
                      : std::span<const std::uint32_t>(levels_[level].cells);
  };
  std::size_t level = 0;
  for (; set(level).size() > kFewCells && level + 1 < levels_.size(); ++level) {
    levels_[level].graph.coarsen(set(level), levels_[level + 1].graph, levels_[level + 1].cells);
    looked_at_ += set(level).size();
  }
  double total = 0;
  for (const std::uint32_t cell : set(level)) total += levels_[level].graph.cost(cell);
  GridHalf half = divide(levels_[level].graph, set(level), total * share);
  for (; level > 0; --level) {
    GridGraph& coarse = levels_[level].graph;
    GridGraph& fine = levels_[level - 1].graph;
    for (const std::uint32_t cell : set(level)) coarse.mark(cell, coarse.at_border(cell));
    near_.clear();
    half.count = 0;
    for (const std::uint32_t cell : set(level - 1)) {
      const std::uint32_t parent = fine.parent(cell);
      fine.put_inside(cell, coarse.is_inside(parent));
      half.count += coarse.is_inside(parent) ? 1 : 0;
      if (coarse.is_marked(parent)) near_.push_back(cell);
    }
    looked_at_ += set(level).size() + set(level - 1).size();
    if (level == 1) half.tolerance = kTolerance * half.wanted;
    refinement_.refine(fine, near_, set(level - 1).size(), half);
  }

  return separate(cells);
}

std::size_t GridBisection::separate(std::span<std::uint32_t> cells) {
  GridGraph& graph = levels_.front().graph;
  for (const std::uint32_t cell : cells) graph.separate(cell);
  rest_.clear();
  std::size_t taken = 0;
  for (const std::uint32_t cell : cells) {
    if (graph.is_inside(cell)) {
      cells[taken++] = cell;
    } else {
      rest_.push_back(cell);
    }
  }
  std::copy(rest_.begin(), rest_.end(), cells.begin() + static_cast<std::ptrdiff_t>(taken));
  looked_at_ += cells.size();
  return taken;
}

}  // namespace delray::loadbalance::internal
