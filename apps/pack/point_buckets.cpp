// A call sorts its points by bucket first, so that the lock is taken once for each that it has.
#include "apps/pack/point_buckets.h"

#include <algorithm>

namespace delray::apps {

PointBuckets::PointBuckets(const std::filesystem::path& folder, std::vector<std::uint64_t> begins)
    : file_(folder, "points on their way"),
      begins_(std::move(begins)),
      buckets_(begins_.size() + 1) {}

void PointBuckets::add(std::span<const BucketPoint> points, std::span<const std::uint64_t> places) {
  std::vector<std::uint32_t> bucket_of(points.size()), begin(buckets_.size() + 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto bucket = std::upper_bound(begins_.begin(), begins_.end(), places[i]);
    bucket_of[i] = static_cast<std::uint32_t>(bucket - begins_.begin());
    ++begin[bucket_of[i] + 1];
  }
  for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
  std::vector<BucketPoint> sorted(points.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) sorted[next[bucket_of[i]]++] = points[i];
  for (std::size_t k = 0; k < buckets_.size(); ++k) {
    if (begin[k] == begin[k + 1]) continue;
    const std::lock_guard lock(mutex_);
    append(buckets_[k], std::span(sorted).subspan(begin[k], begin[k + 1] - begin[k]));
  }
}

void PointBuckets::append(Bucket& bucket, std::span<const BucketPoint> points) {
  bucket.count += points.size();
  while (!points.empty()) {
    const std::size_t count = std::min(points.size(), kBlock - bucket.last.size());
    bucket.last.insert(bucket.last.end(), points.begin(),
                       points.begin() + static_cast<std::ptrdiff_t>(count));
    points = points.subspan(count);
    if (bucket.last.size() < kBlock) continue;
    file_.write(blocks_ * kBlock * sizeof(BucketPoint), std::as_bytes(std::span(bucket.last)));
    bucket.blocks.push_back(blocks_++);
    bucket.last.clear();
  }
}

std::vector<BucketPoint> PointBuckets::read(std::size_t number) const {
  const Bucket& bucket = buckets_[number];
  std::vector<BucketPoint> points(bucket.count);
  for (std::size_t i = 0; i < bucket.blocks.size(); ++i) {
    file_.read(bucket.blocks[i] * kBlock * sizeof(BucketPoint),
               std::as_writable_bytes(std::span(points).subspan(i * kBlock, kBlock)));
  }
  std::ranges::copy(bucket.last,
                    points.begin() + static_cast<std::ptrdiff_t>(bucket.blocks.size() * kBlock));
  return points;
}

}  // namespace delray::apps
