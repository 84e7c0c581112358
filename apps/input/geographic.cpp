// Recognizes degrees by the box of the points and scales them by the length of a degree on the
// ellipsoid WGS 84, as a series in the latitude.
#include "apps/input/geographic.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/input/inliers.h"

namespace delray::apps {
namespace {

constexpr double kNeedle = 50;                        // times as high as wide
constexpr double kDeepest = -12e3, kHighest = 100e3;  // metres, of what is measured on the ground

}  // namespace

glm::dvec2 metres_per_degree(double latitude) {
  // Series for the ellipsoid WGS 84; to a centimetre.
  const double phi = latitude * std::numbers::pi / 180;
  const double x = 111412.84 * std::cos(phi) - 93.5 * std::cos(3 * phi) + 0.118 * std::cos(5 * phi);
  const double y = 111132.92 - 559.82 * std::cos(2 * phi) + 1.175 * std::cos(4 * phi) -
                   0.0023 * std::cos(6 * phi);
  return {std::max(x, 1.0), y};  // at the poles there is no east
}

bool is_geographic(const delaunay::PointCloud& points) {
  if (points.geographic) return true;
  if (!points.has_z || points.size() < kFewValues) return false;
  const geometry::Box3d box = usual_box(points);
  const glm::dvec3 size = box.size();
  const double width = std::max(size.x, size.y);
  return width > 0 && size.z > kNeedle * width && box.low.x >= -180 && box.high.x <= 360 &&
         box.low.y >= -90 && box.high.y <= 90 && box.low.z > kDeepest && box.high.z < kHighest;
}

std::optional<glm::dvec2> metres_of_degrees(const delaunay::PointCloud& points,
                                            const std::string& path) {
  if (!is_geographic(points)) return {};
  const geometry::Box3d box = usual_box(points);
  const double latitude = std::clamp((box.low.y + box.high.y) / 2, -90.0, 90.0);
  const glm::dvec2 metres = metres_per_degree(latitude);
  spdlog::warn(
      "{}: x and y are {} degrees of longitude and latitude: drawn in metres, {:.0f} for a degree "
      "of longitude and {:.0f} for one of latitude, as at {:.2f} degrees",
      path, points.geographic ? "in" : "taken for", metres.x, metres.y, latitude);
  return metres;
}

void to_metres(delaunay::PointCloud& points, const std::string& path) {
  const std::optional<glm::dvec2> metres = metres_of_degrees(points, path);
  if (!metres) return;
  for (glm::dvec3& p : points.positions) p = {p.x * metres->x, p.y * metres->y, p.z};
  points.geographic = false;
}

}  // namespace delray::apps
