// The hybrid partition of primitives and screen (Samanta et al. 2000).
//
// The ranks are halved again and again. Boxes, sorted by where they end and where they begin, go
// one by one to the half with less work, from either end of the screen, until all are assigned; the
// screen is then cut where fewest covered pixels lie on the wrong side. If halving along the other
// axis leaves clearly fewer, that is taken. O(boxes + sides of their part of the screen) per
// halving: counting sorts replace comparisons.
//
// Degenerate: boxes outside the frame have no owner, boxes above a share of the cost are
// everybody's. With an empty part of the screen or without boxes the recursion goes on, and ranks
// may end up with neither.
#include "loadbalance/hybrid_partition.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "loadbalance/partitions/cut.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

// A box cut off at the frame's border, never empty.
struct PlacedBox {
  Rect box;
  double cost = 0;
  double covered = 0;  // what part of its pixels
  std::uint32_t index = 0;
};

// Columns or rows, whichever the lines sweep over.
struct Axis {
  bool along_x;
  int low(const Rect& r) const { return along_x ? r.x0 : r.y0; }
  int high(const Rect& r) const { return along_x ? r.x1 : r.y1; }
  int length(const Rect& r) const { return along_x ? r.width() : r.height(); }
  int across(const Rect& r) const { return along_x ? r.height() : r.width(); }
};

// Numbers of items by ascending position, then by number. O(items + range of positions).
template <class Position>
std::vector<std::uint32_t> order_by(std::size_t items, Position&& position) {
  std::vector<std::uint32_t> order(items);
  if (items == 0) return order;
  int begin = position(0), last = begin;
  for (std::size_t i = 1; i < items; ++i) {
    begin = std::min(begin, position(i));
    last = std::max(last, position(i));
  }
  std::vector<std::uint32_t> next(static_cast<std::size_t>(last - begin) + 2);
  for (std::size_t i = 0; i < items; ++i) ++next[position(i) - begin + 1];
  for (std::size_t k = 1; k < next.size(); ++k) next[k] += next[k - 1];
  for (std::size_t i = 0; i < items; ++i)
    order[next[position(i) - begin]++] = static_cast<std::uint32_t>(i);
  return order;
}

class Sweep {
 public:
  Sweep(double pixel_cost, HybridPartition& result) : pixel_cost_(pixel_cost), result_(result) {}

  // The boxes of a part of the screen.
  struct Boxes {
    std::vector<PlacedBox> items, everybodys;
  };

  // `screen` may be empty. Boxes that are everybody's count where they touch it.
  void split(const Rect& screen, Boxes boxes, int owner, int ranks, int depth) {
    const std::vector<PlacedBox>& items = boxes.items;
    if (ranks == 1) {
      if (!screen.empty()) result_.regions.regions.push_back({screen, owner});
      for (const PlacedBox& item : items) result_.owners[item.index] = owner;
      return;
    }
    const int low_ranks = internal::first_half(ranks, depth), high_ranks = ranks - low_ranks;
    const Axis longer{screen.width() >= screen.height()}, shorter{!longer.along_x};
    std::erase_if(boxes.everybodys, [&](const PlacedBox& box) {
      return geometry::intersection(box.box, screen).empty();
    });
    Halves halves = halve(screen, boxes, longer, low_ranks, high_ranks);
    if (halves.misplaced > kNoDifference) {
      Halves others = halve(screen, boxes, shorter, low_ranks, high_ranks);
      if (others.misplaced < kWorthASliver * halves.misplaced) halves = std::move(others);
    }
    Rect low = screen, high = screen;
    (halves.axis.along_x ? low.x1 : low.y1) = halves.border;
    (halves.axis.along_x ? high.x0 : high.y0) = halves.border;
    Boxes low_boxes, high_boxes;
    for (std::size_t i = 0; i < items.size(); ++i)
      (halves.is_low[i] ? low_boxes : high_boxes).items.push_back(items[i]);
    low_boxes.everybodys = boxes.everybodys;
    high_boxes.everybodys = std::move(boxes.everybodys);
    boxes = {};
    split(low, std::move(low_boxes), owner, low_ranks, depth + 1);
    split(high, std::move(high_boxes), owner + low_ranks, high_ranks, depth + 1);
  }

 private:
  struct Halves {
    Axis axis;
    std::vector<bool> is_low;  // whether item i goes to the low half
    int even = 0;              // where a border would leave both halves as much to do
    int border = 0;
    double misplaced = 0;  // pixels on the wrong side of the border
  };

  // A border across the shorter side is taken with at most this part of the other's pixels on the
  // wrong side.
  static constexpr double kWorthASliver = 0.75;
  // In pixels: what rounding may make of none.
  static constexpr double kNoDifference = 1e-3;

  Halves halve(const Rect& screen, const Boxes& boxes, Axis axis, int low_ranks,
               int high_ranks) const {
    Halves halves = assign(screen, boxes, axis, low_ranks, high_ranks);
    find_border(screen, boxes.items, halves);
    return halves;
  }

  // The cost of everybody's boxes before each line of the screen, and of all of it.
  static std::vector<double> everybodys_before(const Rect& screen,
                                               const std::vector<PlacedBox>& everybodys,
                                               Axis axis) {
    std::vector<double> before(static_cast<std::size_t>(axis.length(screen)) + 1);
    for (const PlacedBox& item : everybodys) {
      const Rect inside = geometry::intersection(item.box, screen);
      if (inside.empty()) continue;
      const double per_line =
          item.cost / static_cast<double>(item.box.area()) * axis.across(inside);
      for (int k = axis.low(inside); k < axis.high(inside); ++k)
        before[k - axis.low(screen) + 1] += per_line;
    }
    for (std::size_t k = 1; k < before.size(); ++k) before[k] += before[k - 1];
    return before;
  }

  Halves assign(const Rect& screen, const Boxes& boxes, Axis axis, int low_ranks,
                int high_ranks) const {
    const std::vector<PlacedBox>& items = boxes.items;
    const auto by_end =
        order_by(items.size(), [&](std::size_t i) { return axis.high(items[i].box); });
    const auto by_begin =
        order_by(items.size(), [&](std::size_t i) { return axis.low(items[i].box); });
    const auto work = [&](const PlacedBox& item) {
      const auto outside =
          static_cast<double>(item.box.area() - geometry::intersection(item.box, screen).area());
      return item.cost + pixel_cost_ * outside * item.covered;
    };
    const std::vector<double> before = everybodys_before(screen, boxes.everybodys, axis);
    const auto clamped = [&](int line) {
      return std::clamp(line, axis.low(screen), axis.high(screen));
    };

    Halves halves{axis, std::vector<bool>(items.size())};
    std::vector<bool> is_assigned(items.size());
    int low_line = axis.low(screen), high_line = axis.high(screen);
    double low_work = 0, high_work = 0;
    auto low_next = by_end.begin();
    auto high_next = by_begin.rbegin();
    for (std::size_t left = items.size(); left > 0; --left) {
      const int low_at = clamped(low_line), high_at = clamped(high_line);
      const double shared = pixel_cost_ * std::max(0, low_at - high_at) * axis.across(screen);
      const double low_sum = low_work + shared + before[low_at - axis.low(screen)];
      const double high_sum =
          high_work + shared + before.back() - before[high_at - axis.low(screen)];
      if (low_sum * high_ranks <= high_sum * low_ranks) {
        while (is_assigned[*low_next]) ++low_next;
        const PlacedBox& item = items[*low_next];
        halves.is_low[*low_next] = is_assigned[*low_next] = true;
        low_line = std::max(low_line, axis.high(item.box));
        low_work += work(item);
      } else {
        while (is_assigned[*high_next]) ++high_next;
        const PlacedBox& item = items[*high_next];
        is_assigned[*high_next] = true;
        high_line = std::min(high_line, axis.low(item.box));
        high_work += work(item);
      }
    }
    const double low_share = static_cast<double>(low_ranks) / (low_ranks + high_ranks);
    const auto even =
        std::lower_bound(before.begin(), before.end(),
                         (low_work + high_work + before.back()) * low_share - low_work);
    halves.even =
        axis.low(screen) + (before.back() > 0 ? static_cast<int>(even - before.begin())
                                              : static_cast<int>(axis.length(screen) * low_share));
    return halves;
  }

  // The border with the fewest pixels on the wrong side; of borders that are as good as each other,
  // the one that leaves the halves most alike.
  static void find_border(const Rect& screen, const std::vector<PlacedBox>& items, Halves& halves) {
    const Axis axis = halves.axis;
    const int begin = axis.low(screen), length = axis.length(screen);
    // Pixels covered in line begin + k by boxes of the low half, or of the high one: no more than
    // the line has, where they overlap each other.
    const auto covered_by = [&](bool low) {
      std::vector<double> lines(static_cast<std::size_t>(length) + 1);
      for (std::size_t i = 0; i < items.size(); ++i) {
        const Rect inside = geometry::intersection(items[i].box, screen);
        if (halves.is_low[i] != low || inside.empty()) continue;
        const double covered = items[i].covered * axis.across(inside);
        lines[axis.low(inside) - begin] += covered;
        lines[axis.high(inside) - begin] -= covered;
      }
      double sum = 0;
      for (double& line : lines) {
        sum += line;
        line = std::min<double>(sum, axis.across(screen));
      }
      return lines;
    };
    const std::vector<double> low_lines = covered_by(true), high_lines = covered_by(false);

    const int first = std::min(1, length), last = std::max(first, length - 1);
    const int even = halves.even - begin;
    // In pixels on the wrong side, as the border moves on from `first`.
    double change = 0, least = 0;
    halves.misplaced = std::accumulate(low_lines.begin() + first, low_lines.end(), 0.0) +
                       std::accumulate(high_lines.begin(), high_lines.begin() + first, 0.0);
    int best = first;
    for (int k = first; k < last;) {
      change += high_lines[k] - low_lines[k];
      ++k;
      if (change < least - kNoDifference ||
          (change <= least + kNoDifference && std::abs(k - even) < std::abs(best - even))) {
        least = std::min(least, change);
        best = k;
      }
    }
    halves.border = begin + best;
    halves.misplaced += least;
  }

  double pixel_cost_;
  HybridPartition& result_;
};

}  // namespace

HybridPartition hybrid_partition(std::span<const WeightedBox> boxes, Rect frame, int ranks,
                                 const HybridOptions& options) {
  if (ranks < 1 || !(options.pixel_cost >= 0) || !(options.largest_box >= 0))
    throw std::invalid_argument("there is at least one rank, and no cost or size is negative");
  HybridPartition result{std::vector<int>(boxes.size(), kNobody), {frame, {}}};
  std::vector<PlacedBox> items, everybodys;
  double all = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Rect visible = geometry::intersection(boxes[i].box, frame);
    if (visible.empty()) continue;
    const double covered =
        std::min(1.0, (boxes[i].cost - boxes[i].setup) / static_cast<double>(visible.area()));
    items.push_back({visible, boxes[i].cost, covered, static_cast<std::uint32_t>(i)});
    all += boxes[i].cost;
  }
  if (ranks > 1) {
    std::erase_if(items, [&](const PlacedBox& item) {
      if (item.cost * ranks <= options.largest_box * all) return false;
      result.owners[item.index] = kEverybody;
      everybodys.push_back(item);
      return true;
    });
  }
  if (!frame.empty()) {
    Sweep(options.pixel_cost, result)
        .split(frame, {std::move(items), std::move(everybodys)}, 0, ranks, 0);
  }
  return result;
}

}  // namespace delray::loadbalance
