// Hits that may be shared with a neighbouring triangle.
#pragma once

#include "raytrace/ray.h"

namespace delray::raytrace {

// Barycentric: more than rounding makes of them for a ray that hits both triangles of an edge.
inline constexpr float kNearEdge = 1e-5F;

// Whether a hit is so near to an edge that the ray may hit the next triangle as well.
inline bool is_on_edge(float u, float v) {
  return u < kNearEdge || v < kNearEdge || 1.0F - (u + v) < kNearEdge;
}

// Which active rays have such hits, and whether any has.
bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges);

}  // namespace delray::raytrace
