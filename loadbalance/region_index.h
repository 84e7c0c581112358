// An index of regions by place: finds those that a box touches without a look at all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

// A grid of buckets over the frame, about one for each region. O(regions + buckets) to build where
// regions are about equally large.
class RegionIndex {
 public:
  // Refers to the partition, which must outlive it.
  explicit RegionIndex(const Partition& partition);

  // Calls f(region, common pixels) once for each region that has some of the box.
  // O(regions near the box).
  template <class F>
  void for_each_region(const geometry::Rect& box, F&& f) const {
    const geometry::Rect visible = geometry::intersection(box, frame_);
    if (visible.empty()) return;
    const int j0 = row(visible.y0), j1 = row(visible.y1 - 1);
    const int i0 = column(visible.x0), i1 = column(visible.x1 - 1);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const std::size_t bucket = static_cast<std::size_t>(j) * columns_ + i;
        for (std::uint32_t k = first_[bucket]; k < first_[bucket + 1]; ++k) {
          const Region& region = (*regions_)[in_bucket_[k]];
          const geometry::Rect common = geometry::intersection(region.rect, visible);
          if (common.empty()) continue;
          // In several buckets it counts where its first pixel lies.
          if (row(common.y0) == j && column(common.x0) == i) f(region, common);
        }
      }
    }
  }

  // Replaces `owners` by those that have some of the box, ascending.
  void owners_of(const geometry::Rect& box, std::vector<int>& owners) const;

 private:
  int column(int x) const { return (x - frame_.x0) / width_; }
  int row(int y) const { return (y - frame_.y0) / height_; }

  const std::vector<Region>* regions_;
  geometry::Rect frame_;
  int columns_ = 0, width_ = 1, height_ = 1;  // width_, height_: of a bucket
  std::vector<std::uint32_t> first_;          // by bucket, into in_bucket_, and the end
  std::vector<std::uint32_t> in_bucket_;
};

}  // namespace delray::loadbalance
