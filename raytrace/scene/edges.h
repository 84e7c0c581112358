// Hits that may be shared with a neighbouring triangle.
#pragma once

#include <cmath>

#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// Barycentric: more than rounding makes of them for a ray that hits both triangles of an edge.
inline constexpr float kNearEdge = 1e-5F;

// Beyond what rounding does to distances of triangles that meet in a point: Embree leaves out hits
// that are a few roundings before the end of a ray.
inline float a_little_further(float distance) { return distance + std::abs(distance) * 1e-6F; }

// Whether a hit is so near to an edge that the ray may hit the next triangle as well.
inline bool is_on_edge(float u, float v) {
  return u < kNearEdge || v < kNearEdge || 1.0F - (u + v) < kNearEdge;
}

// Which active rays have such hits, and whether any has.
bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges);

}  // namespace delray::raytrace
