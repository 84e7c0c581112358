#include <cassert>

#include "loadbalance/partition.h"

namespace delray::loadbalance {
namespace {

// The cells of one side of the grid that reach into [begin, end) of it; found from the cell that
// covers begin.
struct Span {
  int first, last;
};

template <class Border>
Span overlapped(int begin, int end, int cells, Border&& border) {
  int low = 0, high = cells - 1;  // the last cell that begins at or before `begin`
  while (low < high) {
    const int middle = low + (high - low + 1) / 2;
    if (border(middle) <= begin) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  Span span{low, low};
  while (span.last < cells && border(span.last) < end) ++span.last;
  return span;
}

}  // namespace

std::vector<double> loads(const Costs& costs, const Partition& partition, int owners) {
  assert(partition.frame == costs.frame);
  std::vector<double> result(static_cast<std::size_t>(owners));
  for (const Region& region : partition.regions) {
    const geometry::Rect& rect = region.rect;
    if (rect.empty()) continue;
    const Span columns =
        overlapped(rect.x0, rect.x1, costs.columns, [&](int i) { return costs.cell(i, 0).x0; });
    const Span rows =
        overlapped(rect.y0, rect.y1, costs.rows, [&](int j) { return costs.cell(0, j).y0; });
    double load = 0;
    for (int j = rows.first; j < rows.last; ++j) {
      for (int i = columns.first; i < columns.last; ++i) {
        const geometry::Rect cell = costs.cell(i, j);
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
