// Mesh-based adaptive hierarchical decomposition (Mueller 1995).
//
// A rectangle of grid cells is cut across its longer side, in pixels, at the border where a
// summed-area table (Crow 1984) comes nearest to the share of the cost that goes with the share of
// the parts; both sides are cut likewise. O(cells + parts log cells).
//
// Degenerate: without cost a cut goes by area. A single cell is not cut, so with more parts than
// cells some owners have none.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "loadbalance/partitions/cut.h"
#include "loadbalance/partitions/partitioners.h"
#include "loadbalance/partitions/summed_area.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

class Decomposition {
 public:
  Decomposition(const Costs& costs, Partition& partition)
      : costs_(costs), sums_(costs.columns, costs.rows, costs.cells), partition_(partition) {}

  // Gives the cells of `cells` to the owners from `owner` on, `parts` of them.
  void split(const Rect& cells, int owner, int parts, int depth) {
    const bool columns = cells.width() > 1, rows = cells.height() > 1;
    if (parts == 1 || (!columns && !rows)) {
      const Rect pixels = pixels_of(cells);
      if (!pixels.empty()) partition_.regions.push_back({pixels, owner});
      return;
    }
    const Rect pixels = pixels_of(cells);
    const bool vertical = columns && (!rows || pixels.width() >= pixels.height());
    const int first_parts = first_half(parts, depth);
    Rect first = cells, second = cells;
    if (vertical) {
      first.x1 = second.x0 = cut_at_share(cells.x0, cells.x1, first_parts, parts, [&](int x) {
        return sums_.sum({cells.x0, cells.y0, x, cells.y1});
      });
    } else {
      first.y1 = second.y0 = cut_at_share(cells.y0, cells.y1, first_parts, parts, [&](int y) {
        return sums_.sum({cells.x0, cells.y0, cells.x1, y});
      });
    }
    split(first, owner, first_parts, depth + 1);
    split(second, owner + first_parts, parts - first_parts, depth + 1);
  }

 private:
  Rect pixels_of(const Rect& cells) const {
    const Rect first = costs_.cell(cells.x0, cells.y0);
    const Rect last = costs_.cell(cells.x1 - 1, cells.y1 - 1);
    return {first.x0, first.y0, last.x1, last.y1};
  }

  const Costs& costs_;
  SummedArea sums_;
  Partition& partition_;
};

}  // namespace

Partition mahd(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  assert(frame == costs.frame);
  assert(std::all_of(costs.cells.begin(), costs.cells.end(),
                     [](double cost) { return std::isfinite(cost) && cost >= 0; }));
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  Decomposition(costs, partition).split({0, 0, costs.columns, costs.rows}, 0, parts, 0);
  return partition;
}

}  // namespace delray::loadbalance::internal
