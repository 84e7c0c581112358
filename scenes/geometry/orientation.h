// On which side of a line a point of the plane lies, exactly.
#pragma once

#include <glm/glm.hpp>

namespace delray::scenes::internal {

// +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they lie on one line.
//
// REQUIRES: the coordinates are finite numbers of single precision.
int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

}  // namespace delray::scenes::internal
