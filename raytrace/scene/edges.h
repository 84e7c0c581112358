// Hits that may be shared with a neighbouring triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// Barycentric, how near to an edge a ray that hits a triangle may hit the next one at the same
// distance, by rounding: where they are slivers to the ray, or the edge is a sharp ridge. Of
// sharper ones, whose sheets lie in each other for rays, and triangles that are shorter than
// roundings of the way to them, that may be so from further off; that is not looked at.
inline constexpr float kNearEdge = 1.0F / 128;

// Beyond what rounding does to distances of triangles that meet in a point: Embree leaves out hits
// that are a few roundings before the end of a ray.
inline float a_little_further(float distance) { return distance + std::abs(distance) * 1e-6F; }

// Barycentric, to the nearest of a triangle's edges.
inline float distance_from_edges(float u, float v) {
  return std::min(std::min(u, v), 1.0F - (u + v));
}

// Which active rays have hits near an edge, and whether any has.
bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges);

}  // namespace delray::raytrace
