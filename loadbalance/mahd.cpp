#include <algorithm>
#include <cassert>
#include <cmath>

#include "loadbalance/internal/partitioners.h"
#include "loadbalance/summed_area.h"

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
    const int first_parts = depth % 2 == 0 ? (parts + 1) / 2 : parts / 2;
    Rect first = cells, second = cells;
    if (vertical) {
      first.x1 = second.x0 = cut(cells.x0, cells.x1, first_parts, parts, [&](int x) {
        return sums_.sum({cells.x0, cells.y0, x, cells.y1});
      });
    } else {
      first.y1 = second.y0 = cut(cells.y0, cells.y1, first_parts, parts, [&](int y) {
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

  // The border strictly between `low` and `high` where the cost before it is nearest to its share;
  // cost_before does not decrease.
  template <class CostBefore>
  static int cut(int low, int high, int first_parts, int parts, CostBefore&& cost_before) {
    const double total = cost_before(high);
    if (!(total > 0)) {
      const double position = static_cast<double>(high - low) * first_parts / parts;
      return std::clamp(low + static_cast<int>(position + 0.5), low + 1, high - 1);
    }
    const double wanted = total * first_parts / parts;
    int first = low + 1, last = high - 1;  // the first border that reaches it, or high - 1
    while (first < last) {
      const int middle = first + (last - first) / 2;
      if (cost_before(middle) < wanted) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    if (first == low + 1) return first;
    const double above = std::abs(cost_before(first) - wanted);
    const double below = std::abs(wanted - cost_before(first - 1));
    return above < below ? first : first - 1;
  }

  const Costs& costs_;
  SummedArea sums_;
  Partition& partition_;
};

}  // namespace

Partition mahd(const Costs& costs, Rect frame, int parts) {
  assert(parts >= 1);
  assert(frame == costs.frame);
  assert(std::all_of(costs.cells.begin(), costs.cells.end(),
                     [](double cost) { return std::isfinite(cost) && cost >= 0; }));
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  Decomposition(costs, partition).split({0, 0, costs.columns, costs.rows}, 0, parts, 0);
  return partition;
}

}  // namespace delray::loadbalance::internal
