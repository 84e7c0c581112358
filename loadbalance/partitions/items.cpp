// Clips boxes to the frame for partitions that work on boxes, or turns cells with a cost into boxes
// where none were given.
#include "loadbalance/partitions/items.h"

namespace delray::loadbalance::internal {

std::vector<Item> items_of(const Costs& costs) {
  std::vector<Item> items;
  items.reserve(costs.boxes.size());
  for (const WeightedBox& box : costs.boxes) {
    const geometry::Rect visible = geometry::intersection(box.box, costs.frame);
    if (visible.empty()) continue;
    items.push_back({visible, box.setup,
                     (box.cost - box.setup) / static_cast<double>(visible.area()),
                     static_cast<double>(box.primitives)});
  }
  if (!costs.boxes.empty() || costs.frame.empty()) return items;
  std::size_t k = 0;
  for (int j = 0; j < costs.rows; ++j) {
    for (int i = 0; i < costs.columns; ++i, ++k) {
      const double cost = costs.cells[k];
      if (!(cost > 0)) continue;
      const geometry::Rect cell = costs.cell(i, j);
      items.push_back({cell, 0, cost / static_cast<double>(cell.area()), cost});
    }
  }
  return items;
}

}  // namespace delray::loadbalance::internal
