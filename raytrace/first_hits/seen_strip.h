// Triangles that rays may hit far beyond the box around them: those seen from the side, and
// slivers.
#pragma once

#include <array>
#include <vector>

#include "raytrace/first_hits/seen_from.h"
#include "raytrace/first_hits/triangle_bins.h"

namespace delray::raytrace {

// Beyond this many pixels around a triangle, or a line, a box or a strip is not worth it.
inline constexpr float kWidest = 64.0F;

// Appends `triangle`, whose corners in the space of rays are these, in the blocks that rays may hit
// it in, however rays are rounded: once for each row of blocks, or in all of the window where it
// is not before the eye. O(rows).
void find_strip(const std::array<glm::vec3, 3>& corners, const SeenFrom& from,
                WideTriangle triangle, std::vector<WideTriangle>& seen);

}  // namespace delray::raytrace
