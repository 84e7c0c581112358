// The grid as a graph, partitioned by recursive bisection (Kurc, Aykanat and Ozguc 1997).
//
// GridBisection halves the cells again and again so that little cost crosses the cut. Cells of one
// owner are then joined to rectangles: into runs along a row, and each run with that of the row
// above if both have the same ends. O(cells log parts).
//
// Degenerate: with more parts than cells some owners have none; regions of an owner may lie apart.
#include <map>
#include <span>
#include <utility>

#include "loadbalance/partitions/cut.h"
#include "loadbalance/partitions/grid_bisection.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

void split(GridBisection& bisection, std::span<std::uint32_t> cells, int owner, int parts,
           int depth, std::vector<int>& owners) {
  if (parts == 1 || cells.size() < 2) {
    for (const std::uint32_t cell : cells) owners[bisection.place(cell)] = owner;
    return;
  }
  const int first_parts = first_half(parts, depth);
  const std::size_t taken = bisection.cut(cells, static_cast<double>(first_parts) / parts);
  split(bisection, cells.first(taken), owner, first_parts, depth + 1, owners);
  split(bisection, cells.subspan(taken), owner + first_parts, parts - first_parts, depth + 1,
        owners);
}

// Runs of cells of one owner, joined with those of the row above that have the same ends.
std::vector<Region> rectangles(const Costs& costs, const std::vector<int>& owners) {
  std::vector<Region> regions;
  std::map<std::pair<int, int>, std::size_t> above, here;  // region by the columns of its run
  for (int j = 0; j < costs.rows; ++j) {
    here.clear();
    const int* row = owners.data() + static_cast<std::ptrdiff_t>(j) * costs.columns;
    for (int begin = 0, end = 0; begin < costs.columns; begin = end) {
      while (end < costs.columns && row[end] == row[begin]) ++end;
      const Rect first = costs.cell(begin, j), last = costs.cell(end - 1, j);
      const auto same = above.find({begin, end});
      if (same != above.end() && regions[same->second].owner == row[begin]) {
        regions[same->second].rect.y1 = last.y1;
        here[{begin, end}] = same->second;
      } else {
        here[{begin, end}] = regions.size();
        regions.push_back({{first.x0, first.y0, last.x1, last.y1}, row[begin]});
      }
    }
    std::swap(above, here);
  }
  return regions;
}

}  // namespace

Partition graph(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  if (frame.empty()) return {frame, {}};
  GridBisection bisection(costs);
  std::vector<std::uint32_t> cells = bisection.cells();
  std::vector<int> owners(cells.size());
  split(bisection, cells, 0, parts, 0, owners);
  return {frame, rectangles(costs, owners)};
}

}  // namespace delray::loadbalance::internal
