// From a hit to the point on the surface.
#pragma once

#include <glm/glm.hpp>

#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/ray.h"
#include "shading/surface.h"

namespace delray::raytrace {

// The width of the cone around a ray that stands for its pixel (Amanatides 1984), where it hits.
struct Cone {
  float width = 0.0F;
};

// A slant beyond which a footprint grows no further.
inline constexpr float kSteepest = 0.05F;

// Squares of twice the areas of triangles that leave room for rounding and below overflow; others
// are measured with their longest edge for a unit.
inline constexpr float kLeastSquare = 1e-36F, kMostSquare = 1e36F;

// 2^-18 is 64 roundings of a float; Embree's intersection and the sums of a point take about 20.
inline constexpr float kOffset = 0x1p-18F;

struct Intersection {
  shading::Point point;
  // A ray that starts this far from the point along either direction of the geometric normal cannot
  // hit the triangle that it leaves, whatever is rounded on the way: a multiple of the largest
  // number that took part (the triangle's corners in its own space and in the world), after the
  // ideas of Waechter and Binder (2019).
  float offset = 0.0F;
};

// `direction` is the unit direction of the ray. REQUIRES: the instance and triangle of `hit`
// exist.
Intersection intersection(const GeometryInstance& instance, const Hit& hit,
                          const glm::vec3& direction, const Cone& cone);

// Texture coordinates of a set and vertex alpha alone, for shading::coverage.
struct CoveragePoint {
  glm::vec2 uv{0.0F};
  float alpha = 1.0F;
};
CoveragePoint coverage_point(const GeometryInstance& instance, const Hit& hit, int set);

}  // namespace delray::raytrace
