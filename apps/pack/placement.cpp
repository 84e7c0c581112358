// The sample tells degrees and the usual box; where that says that all points are inliers, nothing
// else has to be looked at.
#include "apps/pack/placement.h"

#include <array>
#include <optional>

#include "apps/input/geographic.h"
#include "apps/input/relief.h"

namespace delray::apps {

glm::vec3 Placement::operator()(const glm::dvec3& point) const {
  return in_relief(point * scale, scene.origin, exaggeration);
}

Placement place_points(
    const SceneInput& input, delaunay::PointCloud& sample, const geometry::Box3d& box,
    std::uint64_t count,
    const std::function<Inliers(const glm::dvec3& scale, const geometry::Box3d& limits)>&
        look_for_inliers) {
  Placement placement;
  placement.exaggeration = input.exaggeration;
  if (const std::optional<glm::dvec2> metres = metres_of_degrees(sample, input.file.path))
    placement.scale = {metres->x, metres->y, 1};
  for (glm::dvec3& p : sample.positions) p *= placement.scale;
  placement.box = {box.low * placement.scale, box.high * placement.scale};
  const geometry::Box3d limits = limits_of_inliers(sample);
  placement.inliers = {placement.box, 0};
  if (!is_within(placement.box.low, limits) || !is_within(placement.box.high, limits))
    placement.inliers = look_for_inliers(placement.scale, limits);
  check_reach(input, std::array{placement.box.low, placement.box.high},
              placement.inliers.box.centre());
  warn_of_outliers(input, placement.inliers, count);
  placement.scene = around_relief(placement.inliers, input.exaggeration);
  if (!input.up.empty()) placement.scene.z_up = input.up == "z";
  return placement;
}

}  // namespace delray::apps
