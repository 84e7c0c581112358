// Polygons of files, cut into triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace delray::scenes::internal {

// Appends n - 2 triangles that cover the simple polygon of `corners` (indices of `positions`), in
// its sense. It may touch itself and pass an edge in both directions, as polygons with holes do
// whose outline is joined to them by an edge; corners that have only such edges are left out, two
// triangles each. A polygon that crosses itself
// gets triangles that need not cover it well. Nothing for less than 3 corners. O(n log n).
//
// REQUIRES: positions are finite.
void triangulate_polygon(std::span<const std::uint32_t> corners,
                         std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles);

}  // namespace delray::scenes::internal
