// Where points that memory does not hold come to lie in a scene.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "apps/input/scene_input.h"

namespace delray::apps {

// As load_scene() places all of them.
struct Placement {
  glm::dvec3 scale{1};  // of degrees to metres
  geometry::Box3d box;  // of all points, scaled
  Inliers inliers;      // scaled
  scenes::Scene scene;  // without a mesh
  double exaggeration = 1;

  glm::vec3 operator()(const glm::dvec3& point) const;
  int up() const { return scene.z_up ? 2 : 1; }
};

// `sample` has every k-th of `count` points, as usual_range takes them, and is scaled; `box` is
// that of all points. `look_for_inliers(scale, limits)` looks at all of them, once at most. Throws
// FileError for points too far from each other.
Placement place_points(
    const SceneInput& input, delaunay::PointCloud& sample, const geometry::Box3d& box,
    std::uint64_t count,
    const std::function<Inliers(const glm::dvec3& scale, const geometry::Box3d& limits)>&
        look_for_inliers);

}  // namespace delray::apps
