// Median cut of the primitives' centroids (Whelan 1985).
//
// The longer side of a region is cut where the numbers of centroids on either side are as the
// numbers of parts, from prefix sums over its columns or rows. O((boxes + pixels along a side) log
// parts).
//
// Degenerate: without centroids a cut goes by area; a region of one pixel is not cut, so with more
// parts than pixels some owners have none.
#include <utility>

#include "loadbalance/partitions/cut.h"
#include "loadbalance/partitions/items.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

struct Centroid {
  int x, y;  // the pixel it lies in
  double primitives;
};

class MedianCut {
 public:
  explicit MedianCut(Partition& partition) : partition_(partition) {}

  void split(const Rect& rect, std::vector<Centroid> centroids, int owner, int parts, int depth) {
    if (parts == 1 || rect.area() <= 1) {
      partition_.regions.push_back({rect, owner});
      return;
    }
    const bool vertical = rect.width() >= rect.height();
    const auto position = [vertical](const Centroid& c) { return vertical ? c.x : c.y; };
    const int low = vertical ? rect.x0 : rect.y0, high = vertical ? rect.x1 : rect.y1;
    before_.assign(static_cast<std::size_t>(high - low) + 1, 0);
    for (const Centroid& c : centroids) before_[position(c) - low + 1] += c.primitives;
    for (std::size_t i = 1; i < before_.size(); ++i) before_[i] += before_[i - 1];
    const int first_parts = first_half(parts, depth);
    const int cut = cut_at_share(low, high, first_parts, parts,
                                 [&](int border) { return before_[border - low]; });

    Rect first = rect, second = rect;
    (vertical ? first.x1 : first.y1) = cut;
    (vertical ? second.x0 : second.y0) = cut;
    std::vector<Centroid> beyond;
    std::erase_if(centroids, [&](const Centroid& c) {
      if (position(c) < cut) return false;
      beyond.push_back(c);
      return true;
    });
    split(first, std::move(centroids), owner, first_parts, depth + 1);
    split(second, std::move(beyond), owner + first_parts, parts - first_parts, depth + 1);
  }

 private:
  Partition& partition_;
  std::vector<double> before_;  // primitives whose centroids lie before each border
};

}  // namespace

Partition whelan(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  std::vector<Centroid> centroids;
  for (const Item& item : items_of(costs)) {
    centroids.push_back(
        {item.box.x0 + item.box.width() / 2, item.box.y0 + item.box.height() / 2, item.primitives});
  }
  MedianCut(partition).split(frame, std::move(centroids), 0, parts, 0);
  return partition;
}

}  // namespace delray::loadbalance::internal
