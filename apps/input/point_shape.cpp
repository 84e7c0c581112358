// Points are sorted into square cells of the plane, some four to a cell. Over a terrain the heights
// in a cell are close together: compared with all heights, or, for woods on flat ground, with the
// width of the site. In a closed surface or a volume they are neither. A grid of rows and columns
// with a height in most places is a terrain, however rough.
#include "apps/input/point_shape.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/input/inliers.h"

namespace delray::apps {
namespace {

constexpr std::size_t kFewest = 200;  // points that tell a shape
constexpr double kPointsPerCell = 4;
constexpr double kSpreadOfHeights = 0.25;  // mean spread in a cell of heights in space ...
constexpr double kSpreadOfWidth = 0.1;     // ... and of the longer side of the site

std::size_t distinct_values(const delaunay::PointCloud& points, int k, std::size_t step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points.positions[i][k]);
  std::ranges::sort(values);
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

bool is_grid(const delaunay::PointCloud& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSampledValues);
  const auto n = static_cast<double>(points.size());
  // Scattered points rarely have a coordinate in common.
  if (static_cast<double>(distinct_values(points, 0, step) * step) > 0.5 * n) return false;
  const auto columns = static_cast<double>(distinct_values(points, 0, 1));
  const auto rows = static_cast<double>(distinct_values(points, 1, 1));
  return rows * columns > 0.5 * n && rows * columns < 2 * n;
}

}  // namespace

bool are_in_space(const delaunay::PointCloud& points) {
  if (!points.has_z || points.size() < kFewest) return false;
  const geometry::Box3d box = usual_box(points);
  const glm::dvec3 size = box.size();
  const double width = std::max(size.x, size.y);
  if (!(size.z > 0)) return false;
  if (!(width > 0)) return true;

  struct Sample {
    std::size_t cell;
    double height;
  };
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSampledValues);
  const auto expected = static_cast<double>(points.size() / step);
  const double cells = std::max(1.0, std::sqrt(expected / kPointsPerCell));
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const glm::dvec3& p = points.positions[i];
    const auto place = [&](double value, double low) {
      return static_cast<std::size_t>(std::clamp((value - low) / width * cells, 0.0, cells));
    };
    samples.push_back(
        {place(p.y, box.low.y) * static_cast<std::size_t>(cells + 2) + place(p.x, box.low.x),
         std::clamp(p.z, box.low.z, box.high.z)});
  }
  std::ranges::sort(samples, {}, &Sample::cell);
  double spread = 0, counted = 0;
  for (std::size_t first = 0, last = 0; first < samples.size(); first = last) {
    double low = samples[first].height, high = low;
    for (; last < samples.size() && samples[last].cell == samples[first].cell; ++last) {
      low = std::min(low, samples[last].height);
      high = std::max(high, samples[last].height);
    }
    if (last - first < 2) continue;
    // Every point counts the same, wherever there are many.
    spread += (high - low) * static_cast<double>(last - first);
    counted += static_cast<double>(last - first);
  }
  if (counted == 0) return false;
  const double mean = spread / counted;
  return mean > kSpreadOfHeights * size.z && mean > kSpreadOfWidth * width && !is_grid(points);
}

}  // namespace delray::apps
