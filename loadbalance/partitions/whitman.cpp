// An adaptive quadtree over the cost grid, with more leaves than parts (Whitman 1992).
//
// Cells hold the number of primitives that overlap them, from two-dimensional differences and their
// prefix sums. A priority queue divides the node with the highest sum until there are several
// leaves for each part, which are assigned largest first (Graham 1969). O(boxes + cells + parts log
// parts).
//
// Degenerate: of nodes with equal sums the largest is divided; leaves without primitives go to the
// part that has least. A cell is not divided, so with more parts than cells some have none.
#include <algorithm>
#include <queue>
#include <tuple>

#include "loadbalance/partitions/items.h"
#include "loadbalance/partitions/largest_first.h"
#include "loadbalance/partitions/partitioners.h"
#include "loadbalance/partitions/summed_area.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

constexpr std::size_t kRegionsPerPart = 10;

// In each cell, how many primitives overlap it. Counted by differences: O(boxes + cells).
std::vector<double> counted_mesh(const Costs& costs) {
  const auto columns = static_cast<std::size_t>(costs.columns);
  const auto rows = static_cast<std::size_t>(costs.rows);
  const std::size_t stride = columns + 1;
  std::vector<double> change(stride * (rows + 1));
  for (const Item& item : items_of(costs)) {
    const Rect cells = costs.cells_of(item.box);
    change[cells.y0 * stride + cells.x0] += item.primitives;
    change[cells.y0 * stride + cells.x1] -= item.primitives;
    change[cells.y1 * stride + cells.x0] -= item.primitives;
    change[cells.y1 * stride + cells.x1] += item.primitives;
  }
  std::vector<double> mesh(columns * rows), above(columns);
  for (std::size_t j = 0; j < rows; ++j) {
    double row = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      row += change[j * stride + i];
      above[i] += row;
      mesh[j * columns + i] = std::max(0.0, above[i]);  // rounding may leave less
    }
  }
  return mesh;
}

struct CostNode {
  double count;
  Rect cells;
  // By count; of equal ones the larger first, so that empty frames are cut, too; then by place.
  bool operator<(const CostNode& other) const {
    return std::tuple(count, cells.area(), -cells.y0, -cells.x0) <
           std::tuple(other.count, other.cells.area(), -other.cells.y0, -other.cells.x0);
  }
};

}  // namespace

Partition whitman(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  const SummedArea sums(costs.columns, costs.rows, counted_mesh(costs));
  std::priority_queue<CostNode> open;  // nodes that have children
  std::vector<CostNode> leaves;        // cells
  const auto add = [&](const Rect& cells) {
    if (cells.empty()) return;
    const CostNode node{sums.sum(cells), cells};
    if (cells.area() == 1) {
      leaves.push_back(node);
    } else {
      open.push(node);
    }
  };
  add({0, 0, costs.columns, costs.rows});
  while (!open.empty() &&
         open.size() + leaves.size() < kRegionsPerPart * static_cast<std::size_t>(parts)) {
    const Rect c = open.top().cells;
    open.pop();
    const int x = c.x0 + (c.width() + 1) / 2, y = c.y0 + (c.height() + 1) / 2;
    for (const Rect& quarter : {Rect{c.x0, c.y0, x, y}, Rect{x, c.y0, c.x1, y},
                                Rect{c.x0, y, x, c.y1}, Rect{x, y, c.x1, c.y1}}) {
      add(quarter);
    }
  }
  for (; !open.empty(); open.pop()) leaves.push_back(open.top());

  std::vector<double> counts;
  counts.reserve(leaves.size());
  for (const CostNode& leaf : leaves) counts.push_back(leaf.count);
  const std::vector<int> owners = largest_first(counts, parts);
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    const Rect& cells = leaves[k].cells;
    const Rect first = costs.cell(cells.x0, cells.y0),
               last = costs.cell(cells.x1 - 1, cells.y1 - 1);
    partition.regions.push_back({{first.x0, first.y0, last.x1, last.y1}, owners[k]});
  }
  return partition;
}

}  // namespace delray::loadbalance::internal
