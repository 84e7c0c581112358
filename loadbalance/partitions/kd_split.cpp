// Recursive bisection by sweep lines over the edges of boxes (Samanta et al. 1999).
//
// Along an axis the cost on the left of the line grows and that on its right falls; both curves
// come from prefix sums over the lines of the region, and a binary search finds where they cross,
// each over its number of parts. The longer side is cut unless the other is clearly better.
// O((boxes, counted in each region that they overlap, + pixels along a side) log parts).
//
// Degenerate: without cost a cut goes by area; a region of one pixel is not cut, so with more parts
// than pixels some owners have none.
#include <algorithm>
#include <utility>

#include "loadbalance/partitions/cut.h"
#include "loadbalance/partitions/items.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

// Columns or rows of a region, whichever a sweep line crosses.
struct Axis {
  bool vertical;  // the sweep line
  int low(const Rect& r) const { return vertical ? r.x0 : r.y0; }
  int high(const Rect& r) const { return vertical ? r.x1 : r.y1; }
  int across(const Rect& r) const { return vertical ? r.height() : r.width(); }
};

struct Cut {
  int border = 0;
  double worst = 0;  // of both sides the higher cost per part
};

class Sweep {
 public:
  explicit Sweep(Partition& partition) : partition_(partition) {}

  // The items overlap `rect`.
  void split(const Rect& rect, std::vector<Item> items, int owner, int parts, int depth) {
    if (parts == 1 || rect.area() <= 1) {
      partition_.regions.push_back({rect, owner});
      return;
    }
    const int first_parts = first_half(parts, depth);
    const bool wide = rect.width() >= rect.height();
    Axis axis{wide};
    Cut cut = best_cut(rect, items, axis, first_parts, parts);
    const Axis other{!wide};
    if (other.high(rect) - other.low(rect) > 1) {
      const Cut candidate = best_cut(rect, items, other, first_parts, parts);
      if (candidate.worst < kWorthASliver * cut.worst) {
        axis = other;
        cut = candidate;
      }
    }
    Rect first = rect, second = rect;
    (axis.vertical ? first.x1 : first.y1) = cut.border;
    (axis.vertical ? second.x0 : second.y0) = cut.border;
    std::vector<Item> beyond;
    for (const Item& item : items) {
      if (axis.high(item.box) > cut.border) beyond.push_back(item);
    }
    std::erase_if(items, [&](const Item& item) { return axis.low(item.box) >= cut.border; });
    split(first, std::move(items), owner, first_parts, depth + 1);
    split(second, std::move(beyond), owner + first_parts, parts - first_parts, depth + 1);
  }

 private:
  // The factor by which a cut across the shorter side must be better.
  static constexpr double kWorthASliver = 0.97;

  // The border where the two curves are nearest to crossing, each over its number of parts.
  Cut best_cut(const Rect& rect, const std::vector<Item>& items, Axis axis, int first_parts,
               int parts) {
    const int low = axis.low(rect), high = axis.high(rect);
    const std::size_t length = static_cast<std::size_t>(high - low);
    begins_.assign(length + 1, 0);
    ends_.assign(length + 1, 0);
    slope_.assign(length + 1, 0);
    double setups = 0;
    for (const Item& item : items) {
      const Rect box = geometry::intersection(item.box, rect);
      const int begin = axis.low(box) - low, end = axis.high(box) - low;
      const double per_line = item.density * axis.across(box);
      begins_[begin] += item.setup;
      ends_[end] += item.setup;
      slope_[begin] += per_line;
      slope_[end] -= per_line;
      setups += item.setup;
    }
    left_.assign(length + 1, 0);
    right_.assign(length + 1, 0);
    double area = 0, slope = 0, begun = 0, ended = 0;
    for (std::size_t i = 0; i <= length; ++i) {
      ended += ends_[i];
      left_[i] = begun + area;
      right_[i] = (setups - ended) - area;
      begun += begins_[i];
      slope += slope_[i];
      area += slope;
    }
    const double area_total = left_[length] - begun;
    if (!(area_total + setups > 0)) {
      return {cut_at_share(low, high, first_parts, parts, [](int) { return 0.0; }), 0};
    }
    for (double& cost : right_) cost += area_total;

    const auto worst = [&](int border) {
      return std::max(left_[border - low] / first_parts,
                      right_[border - low] / (parts - first_parts));
    };
    int first = low + 1, last = high - 1;  // the first border where the left curve is above
    while (first < last) {
      const int middle = first + (last - first) / 2;
      if (left_[middle - low] * (parts - first_parts) < right_[middle - low] * first_parts) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    if (first > low + 1 && worst(first - 1) <= worst(first)) --first;
    return {first, worst(first)};
  }

  Partition& partition_;
  std::vector<double> begins_, ends_, slope_;  // what happens at a border: setups and cost per line
  std::vector<double> left_, right_;           // the cost on each side of a border
};

}  // namespace

Partition kd_split(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  Sweep(partition).split(frame, items_of(costs), 0, parts, 0);
  return partition;
}

}  // namespace delray::loadbalance::internal
