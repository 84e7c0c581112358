// Where in a pixel its samples lie.
#pragma once

#include <glm/glm.hpp>

namespace delray::raytrace {

// The position of sample i of n in the pixel, from its top left corner, each coordinate in (0, 1):
// a square number of samples lies on a regular grid (one in the centre), any other on a lattice of
// rank one by the golden ratio. Equal for every pixel. REQUIRES: 0 <= i < n.
glm::vec2 sample_position(int i, int n);

}  // namespace delray::raytrace
