// Points and their triangulation as a scene.
#pragma once

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

}  // namespace delray::apps
