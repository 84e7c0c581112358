// Which of many values are usual, and which are far off all others: a bird, a reflection, a typing
// error.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "delaunay/points.h"
#include "geometry/box.h"

namespace delray::apps {

inline constexpr double kUnusual = 0.005;      // of the values at either end are not looked at
inline constexpr std::size_t kFewValues = 20;  // all of fewer are usual
inline constexpr std::size_t kSampledValues = 1 << 16;  // enough for quantiles to the eye

// The range of all but a few of n values: all but one at either end, or as many as kUnusual says.
// {0, 1} where there are none. O(kSampledValues).
template <class F>
auto usual_range(std::size_t n, F&& value) {
  using Value = std::decay_t<decltype(value(std::size_t{}))>;
  const std::size_t step = std::max<std::size_t>(1, n / kSampledValues);
  std::vector<Value> sample;
  for (std::size_t i = 0; i < n; i += step) sample.push_back(value(i));
  if (sample.empty()) return std::pair{Value(0), Value(1)};
  std::sort(sample.begin(), sample.end());
  const auto share = static_cast<std::size_t>(kUnusual * static_cast<double>(sample.size()));
  const std::size_t skipped = n < kFewValues ? 0 : std::max<std::size_t>(1, share);
  return std::pair{sample[skipped], sample[sample.size() - 1 - skipped]};
}

// The box of the usual range of every coordinate.
geometry::Box3d usual_box(const delaunay::PointCloud& points);

// The usual box and half of its longest side on every side, which inliers are in; all of space
// where nearly all points are equal.
geometry::Box3d limits_of_inliers(const delaunay::PointCloud& points);
inline bool is_within(const glm::dvec3& p, const geometry::Box3d& limits) {
  return glm::all(glm::lessThanEqual(limits.low, p)) &&
         glm::all(glm::lessThanEqual(p, limits.high));
}

struct Inliers {
  geometry::Box3d box;      // of all points but those outside
  std::size_t outside = 0;  // points that are not within limits_of_inliers
};
Inliers find_inliers(const delaunay::PointCloud& points);

}  // namespace delray::apps
