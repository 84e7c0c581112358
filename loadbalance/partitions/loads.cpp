// Adds up each owner's cost from the cells that its regions overlap; a cell that is cut counts by
// the share of its pixels.
#include <stdexcept>
#include <string>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

std::vector<double> loads(const Costs& costs, const Partition& partition, int owners) {
  if (!(partition.frame == costs.frame) || owners < 0)
    throw std::invalid_argument("the costs are of another frame than the partition");
  for (const Region& region : partition.regions) {
    if (region.owner < 0 || region.owner >= owners)
      throw std::invalid_argument("a region's owner is none of " + std::to_string(owners));
  }
  // First pixels of columns and of rows: a cell's rectangle takes divisions.
  std::vector<int> x(static_cast<std::size_t>(costs.columns)),
      y(static_cast<std::size_t>(costs.rows));
  for (int i = 0; i < costs.columns; ++i) x[static_cast<std::size_t>(i)] = costs.cell(i, 0).x0;
  for (int j = 0; j < costs.rows; ++j) y[static_cast<std::size_t>(j)] = costs.cell(0, j).y0;
  x.push_back(costs.frame.x1);
  y.push_back(costs.frame.y1);
  std::vector<double> result(static_cast<std::size_t>(owners));
  for (const Region& region : partition.regions) {
    const geometry::Rect& rect = region.rect;
    const geometry::Rect cells = costs.cells_of(rect);
    double load = 0;
    for (int j = cells.y0; j < cells.y1; ++j) {
      for (int i = cells.x0; i < cells.x1; ++i) {
        const geometry::Rect cell{x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)],
                                  x[static_cast<std::size_t>(i) + 1],
                                  y[static_cast<std::size_t>(j) + 1]};
        const auto common = geometry::intersection(cell, rect).area();
        if (common == 0) continue;
        const double cost =
            costs.cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(costs.columns) +
                        static_cast<std::size_t>(i)];
        load += common == cell.area()
                    ? cost
                    : cost * (static_cast<double>(common) / static_cast<double>(cell.area()));
      }
    }
    result[static_cast<std::size_t>(region.owner)] += load;
  }
  return result;
}

}  // namespace delray::loadbalance
