// The origin of a scene that lies far from 0 for its size.
//
// Coordinates of single precision have steps of some 1e-7 of themselves: those of a house in a
// national grid are half a metre apart. Relative to a point of the scene they are as fine as near
// 0.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/box.h"

namespace delray::scenes::internal {

// Scenes that reach farther from 0 than this many of their diagonals are placed anew: a step of
// single precision would be larger than 4e-6 of the diagonal.
inline constexpr double kFar = 64;
// From here on the steps themselves can be seen: a 1600th of the diagonal.
inline constexpr double kCoarse = 1e4;

// The largest magnitude of a coordinate in the box; 0 for an empty one.
double reach_of(const geometry::Box3d& box);

// The vector to subtract from the coordinates in this box, in double precision, before they are
// rounded to single: its centre where it reaches farther than kFar, else 0, as for an empty box.
glm::dvec3 origin_of(const geometry::Box3d& box);

geometry::Box3d box_of(std::span<const glm::dvec3> positions);
geometry::Box3d box_of(std::span<const glm::vec3> positions);

// Relative to the origin, in single precision. O(positions).
std::vector<glm::vec3> relative_to(const glm::dvec3& origin, std::span<const glm::dvec3> positions);
// Subtracts the origin in place.
void make_relative_to(const glm::dvec3& origin, std::span<glm::vec3> positions);

}  // namespace delray::scenes::internal
