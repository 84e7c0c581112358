// Polygons of files, cut into triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace delray::scenes::internal {

// Appends n - 2 triangles that cover the simple polygon of `corners` (indices of `positions`), in
// its sense. A polygon that is not simple, or too large to look for ears (over 4096 corners), gets
// as many triangles that need not cover it well. Nothing for less than 3 corners. O(1) for 4
// corners, O(n^2) where the polygon is not convex (ear clipping, Meisters 1975).
void triangulate_polygon(std::span<const std::uint32_t> corners,
                         std::span<const glm::vec3> positions, std::vector<glm::uvec3>& triangles);

}  // namespace delray::scenes::internal
