// A regular grid of regions, corrected by one split and one merger at a time (Roble 1988).
//
// Each step halves the region that most primitives overlap and merges the two of the others that
// together have fewest and form a rectangle; neighbours are found by the coordinates of their
// common side. It ends when the merged region would have as many primitives as the one to be split,
// or after a fixed number of steps for each part. O(boxes rows + parts (parts log parts + boxes of
// the largest region)).
//
// Degenerate: without primitives the regular grid stays. With more parts than pixels some owners
// have none.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "loadbalance/partitions/items.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

// Splits per part, at the most: where most primitives stay on one side of a split, the highest
// load falls slowly or not at all.
constexpr int kSplitsPerPart = 4;

struct Part {
  Rect rect;
  std::vector<std::uint32_t> items;  // that overlap it, ascending
  double count = 0;
};

class Roble {
 public:
  Roble(const Rect& frame, std::vector<Item> items, int parts) : items_(std::move(items)) {
    std::vector<std::uint32_t> all(items_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    // As many rows as make the regions about square; the first rows get one region more.
    const double ratio = static_cast<double>(frame.height()) / frame.width();
    const int rows = std::clamp(static_cast<int>(std::lround(std::sqrt(parts * ratio))), 1,
                                std::min(parts, frame.height()));
    for (int j = 0; j < rows; ++j) {
      const int columns = parts / rows + (j < parts % rows ? 1 : 0);
      const Rect row{frame.x0, at(frame.y0, frame.height(), j, rows), frame.x1,
                     at(frame.y0, frame.height(), j + 1, rows)};
      const Part whole = part(row, all);
      for (int i = 0; i < columns; ++i) {
        const Rect rect{at(row.x0, row.width(), i, columns), row.y0,
                        at(row.x0, row.width(), i + 1, columns), row.y1};
        if (!rect.empty()) parts_.push_back(part(rect, whole.items));
      }
    }
  }

  // One split of the region with most, one merger of the two with least. False when no split can
  // make the region with most any lighter than what has to be merged for it.
  bool improve() {
    const auto most =
        std::max_element(parts_.begin(), parts_.end(),
                         [](const Part& a, const Part& b) { return a.count < b.count; });
    if (most->rect.area() <= 1 || !(most->count > 0)) return false;
    const auto pair = lightest_pair(static_cast<std::size_t>(most - parts_.begin()));
    if (!pair) return false;
    auto [a, b] = *pair;
    Part merged;
    std::set_union(parts_[a].items.begin(), parts_[a].items.end(), parts_[b].items.begin(),
                   parts_[b].items.end(), std::back_inserter(merged.items));
    for (const std::uint32_t item : merged.items) merged.count += items_[item].primitives;
    if (merged.count >= most->count) return false;
    merged.rect = {parts_[a].rect.x0, parts_[a].rect.y0, parts_[b].rect.x1, parts_[b].rect.y1};

    Rect first = most->rect, second = most->rect;
    if (first.width() >= first.height()) {
      first.x1 = second.x0 = first.x0 + first.width() / 2;
    } else {
      first.y1 = second.y0 = first.y0 + first.height() / 2;
    }
    Part half = part(first, most->items);
    *most = part(second, most->items);
    parts_[a] = std::move(merged);
    parts_[b] = std::move(half);
    return true;
  }

  Partition partition(const Rect& frame) const {
    Partition result{frame, {}};
    for (const Part& part : parts_) {
      result.regions.push_back({part.rect, static_cast<int>(result.regions.size())});
    }
    return result;
  }

 private:
  static int at(int begin, int length, int i, int n) {
    return begin + static_cast<int>(std::int64_t{length} * i / n);
  }

  Part part(const Rect& rect, const std::vector<std::uint32_t>& candidates) const {
    Part result{rect, {}, 0};
    for (const std::uint32_t item : candidates) {
      if (geometry::intersection(items_[item].box, rect).empty()) continue;
      result.items.push_back(item);
      result.count += items_[item].primitives;
    }
    return result;
  }

  // The two regions, `without` excluded, with the lowest sum that form a rectangle
  // together: left and right, or upper and lower.
  std::optional<std::pair<std::size_t, std::size_t>> lightest_pair(std::size_t without) const {
    std::map<std::tuple<int, int, int>, std::size_t> by_left, by_top;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (k == without) continue;
      const Rect& r = parts_[k].rect;
      by_left[{r.x0, r.y0, r.y1}] = k;
      by_top[{r.y0, r.x0, r.x1}] = k;
    }
    std::optional<std::pair<std::size_t, std::size_t>> best;
    double least = 0;
    const auto consider = [&](std::size_t k, const auto& others, const auto& key) {
      const auto other = others.find(key);
      if (other == others.end()) return;
      const double sum = parts_[k].count + parts_[other->second].count;
      if (best && sum >= least) return;
      best = {k, other->second};
      least = sum;
    };
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (k == without) continue;
      const Rect& r = parts_[k].rect;
      consider(k, by_left, std::tuple(r.x1, r.y0, r.y1));
      consider(k, by_top, std::tuple(r.y1, r.x0, r.x1));
    }
    return best;
  }

  std::vector<Item> items_;
  std::vector<Part> parts_;
};

}  // namespace

Partition roble(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  if (frame.empty()) return {frame, {}};
  Roble roble(frame, items_of(costs), parts);
  for (int k = 0; k < kSplitsPerPart * parts && roble.improve(); ++k) {
  }
  return roble.partition(frame);
}

}  // namespace delray::loadbalance::internal
