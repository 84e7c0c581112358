// Points and their triangulation as a scene.
#pragma once

#include <cstdint>
#include <string>

#include "apps/input/inliers.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "scenes/scene.h"

namespace delray::apps {

// One mesh of the triangles (2D) or of the hull (3D), of none for an empty triangulation; z is up.
// Positions are relative to Scene::origin, the middle of the inliers, so that 32-bit floats do for
// coordinates far away. Heights are multiplied by `exaggeration` for the picture. Where there are
// outliers, cameras frame the inliers.
// The triangles begin with the corner of the lowest row, so that a picture does not depend on how
// they were made or written.
scenes::Scene relief(const delaunay::PointCloud& points,
                     const delaunay::Triangulation& triangulation, const Inliers& inliers,
                     double exaggeration);

// That scene without its mesh, for who makes it in parts, the mesh's name, and where a point comes
// to lie in it.
scenes::Scene around_relief(const Inliers& inliers, double exaggeration);
inline constexpr const char* kReliefName = "points";
inline glm::vec3 in_relief(const glm::dvec3& point, const glm::dvec3& origin, double exaggeration) {
  return (point - origin) * glm::dvec3(1, 1, exaggeration);
}

// A triangle's corners in their order around it, from the one of the lowest row on. `row` has the
// row of each corner.
template <class Row>
glm::uvec3 from_lowest_row(const glm::uvec3& corners, const Row& row) {
  const auto a = row(corners.x), b = row(corners.y), c = row(corners.z);
  if (a < b) return a < c ? corners : glm::uvec3(corners.z, corners.x, corners.y);
  return b < c ? glm::uvec3(corners.y, corners.z, corners.x)
               : glm::uvec3(corners.z, corners.x, corners.y);
}

// Leaves points that no simplex has out of both, as pieces of meshes do. Rows keep their order.
void keep_corners(delaunay::PointCloud& points, delaunay::Triangulation& triangulation);

}  // namespace delray::apps
