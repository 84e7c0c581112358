// The box of the usual range of each coordinate, widened by half of its longest side, tells inliers
// from outliers. Degenerate: where nearly all points are equal, none is an outlier.
#include "apps/input/inliers.h"

#include <limits>

#include "parallel/parallel_for.h"

namespace delray::apps {
namespace {

constexpr std::size_t kPointsPerBlock = 1 << 14;  // some 20 microseconds of comparisons
constexpr double kFarOff = 0.5;                   // sides of the usual box

}  // namespace

geometry::Box3d usual_box(const delaunay::PointCloud& points) {
  geometry::Box3d box;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] =
        usual_range(points.size(), [&](std::size_t i) { return points.positions[i][k]; });
    box.low[k] = low;
    box.high[k] = high;
  }
  return box;
}

geometry::Box3d limits_of_inliers(const delaunay::PointCloud& points) {
  const geometry::Box3d usual = usual_box(points);
  const glm::dvec3 sides = usual.high - usual.low;
  const double reach = kFarOff * std::max({sides.x, sides.y, sides.z});
  if (reach > 0) return {usual.low - reach, usual.high + reach};
  // Where nearly all points are equal, the others are what there is to see.
  const glm::dvec3 all(std::numeric_limits<double>::infinity());
  return {-all, all};
}

Inliers find_inliers(const delaunay::PointCloud& points) {
  const geometry::Box3d limits = limits_of_inliers(points);
  return parallel::parallel_reduce(
      0, points.size(), kPointsPerBlock, Inliers{},
      [&](std::size_t first, std::size_t last) {
        Inliers inliers;
        for (std::size_t i = first; i < last; ++i) {
          const glm::dvec3& p = points.positions[i];
          const bool inside = is_within(p, limits);
          if (inside) inliers.box.include(p);
          inliers.outside += inside ? 0 : 1;
        }
        return inliers;
      },
      [](Inliers a, const Inliers& b) {
        a.box.include(b.box);
        a.outside += b.outside;
        return a;
      });
}

}  // namespace delray::apps
