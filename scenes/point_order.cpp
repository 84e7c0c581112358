// Places go to buckets between splitters from a sample of them, and each bucket is sorted.
//
// Degenerate: points that are all at one place are one bucket, in the order of the input.
#include "scenes/point_order.h"

#include <algorithm>
#include <array>

#include "geometry/hilbert_curve.h"
#include "parallel/parallel_for.h"

namespace delray::scenes {
namespace {

constexpr int kBits = 21;
constexpr std::size_t kBlock = 1 << 16;  // points of which one thread computes the places
constexpr std::size_t kSample = 1 << 14, kBuckets = 256;
constexpr std::size_t kFew = 1 << 12;  // sorted at once

}  // namespace

PointOrder::PointOrder(const geometry::Box3& box) {
  if (box.empty()) return;
  low_ = box.low;
  const glm::dvec3 size = glm::dvec3(box.high) - low_;
  const double longest = std::max({size.x, size.y, size.z});
  constexpr double kCells = (1 << kBits) - 0.5;
  if (longest > 0) scale_ = kCells / longest;
}

std::uint64_t PointOrder::place(const glm::vec3& p) const {
  std::array<std::uint32_t, 3> cell;
  constexpr double kLast = (1 << kBits) - 1;
  for (int k = 0; k < 3; ++k) {
    const double at = (static_cast<double>(p[k]) - low_[k]) * scale_;
    cell[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(std::clamp(at, 0.0, kLast));
  }
  return geometry::place_on_curve(cell, kBits);
}

std::vector<std::uint64_t> equal_runs(std::span<const std::uint64_t> sorted, std::size_t runs) {
  std::vector<std::uint64_t> begins;
  for (std::size_t run = 1; run < runs && !sorted.empty(); ++run) {
    const std::uint64_t begin = sorted[run * sorted.size() / runs];
    if (begin > (begins.empty() ? sorted.front() : begins.back())) begins.push_back(begin);
  }
  return begins;
}

std::vector<PointPlace> order_points(std::span<const glm::vec3> points, const PointOrder& order) {
  const std::size_t n = points.size();
  std::vector<PointPlace> places(n);
  parallel::parallel_for(0, n, kBlock, [&](std::size_t i) {
    places[i] = {order.place(points[i]), static_cast<std::uint32_t>(i)};
  });
  if (n < kFew) {
    std::sort(places.begin(), places.end());
    return places;
  }
  std::vector<std::uint64_t> sample;
  for (std::size_t i = 0; i < n; i += std::max<std::size_t>(1, n / kSample))
    sample.push_back(places[i].place);
  std::sort(sample.begin(), sample.end());
  const std::vector<std::uint64_t> begins = equal_runs(sample, kBuckets);
  const std::size_t buckets = begins.size() + 1, blocks = (n + kBlock - 1) / kBlock;
  const auto bucket = [&](std::size_t i) {
    return static_cast<std::size_t>(
        std::upper_bound(begins.begin(), begins.end(), places[i].place) - begins.begin());
  };
  // offsets[bucket * blocks + block]: where the points of a block go.
  std::vector<std::size_t> offsets(buckets * blocks + 1);
  const auto for_each_block = [&](auto&& f) {
    parallel::parallel_for(0, blocks, 1, [&](std::size_t block) {
      for (std::size_t i = block * kBlock; i < std::min(n, (block + 1) * kBlock); ++i) f(block, i);
    });
  };
  for_each_block(
      [&](std::size_t block, std::size_t i) { ++offsets[bucket(i) * blocks + block + 1]; });
  for (std::size_t k = 1; k < offsets.size(); ++k) offsets[k] += offsets[k - 1];
  std::vector<std::size_t> ends;
  for (std::size_t k = 0; k < buckets; ++k) ends.push_back(offsets[(k + 1) * blocks]);
  std::vector<PointPlace> sorted(n);
  for_each_block([&](std::size_t block, std::size_t i) {
    sorted[offsets[bucket(i) * blocks + block]++] = places[i];
  });
  parallel::parallel_for(0, buckets, 1, [&](std::size_t k) {
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(k == 0 ? 0 : ends[k - 1]);
    std::sort(begin, sorted.begin() + static_cast<std::ptrdiff_t>(ends[k]));
  });
  return sorted;
}

}  // namespace delray::scenes
