// The two triangulations of four points, by their smallest angles.
#pragma once

#include <glm/glm.hpp>

namespace delray::delaunay::internal {

// Whether the smallest angle of the triangles a b c and a c d is larger than that of b c d and
// b d a. Exact; false where they are equal, as for every four points on a circle.
//
// REQUIRES: a, b, c, d is a strictly convex quadrilateral, counterclockwise; finite coordinates.
bool has_larger_angles(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                       const glm::dvec2& d);

}  // namespace delray::delaunay::internal
