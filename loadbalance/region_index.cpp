// Builds a uniform grid of buckets, stored as one list per bucket behind one another: regions are
// counted per bucket, the counts summed up to offsets, and the numbers filled in. O(regions +
// buckets) where regions are about equally large.
#include "loadbalance/region_index.h"

#include <algorithm>
#include <cmath>

namespace delray::loadbalance {

RegionIndex::RegionIndex(const Partition& partition)
    : regions_(&partition.regions), frame_(partition.frame) {
  const auto wanted = std::clamp<std::size_t>(regions_->size(), 1, std::size_t{1} << 16);
  const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(wanted))));
  width_ = std::max(1, (frame_.width() + side - 1) / side);
  height_ = std::max(1, (frame_.height() + side - 1) / side);
  columns_ = (frame_.width() + width_ - 1) / width_;
  const int rows = (frame_.height() + height_ - 1) / height_;
  const auto for_each_bucket = [&](const geometry::Rect& rect, auto&& f) {
    if (rect.empty()) return;
    for (int j = row(rect.y0); j <= row(rect.y1 - 1); ++j) {
      for (int i = column(rect.x0); i <= column(rect.x1 - 1); ++i) {
        f(static_cast<std::size_t>(j) * columns_ + i);
      }
    }
  };
  first_.assign(static_cast<std::size_t>(columns_) * rows + 1, 0);
  for (const Region& region : *regions_) {
    for_each_bucket(region.rect, [&](std::size_t bucket) { ++first_[bucket + 1]; });
  }
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  in_bucket_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t k = 0; k < regions_->size(); ++k) {
    for_each_bucket((*regions_)[k].rect,
                    [&](std::size_t bucket) { in_bucket_[next[bucket]++] = k; });
  }
}

void RegionIndex::owners_of(const geometry::Rect& box, std::vector<int>& owners) const {
  owners.clear();
  for_each_region(
      box, [&](const Region& region, const geometry::Rect&) { owners.push_back(region.owner); });
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
}

}  // namespace delray::loadbalance
