// Hits that may be shared with a neighbouring triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// Barycentric: more than rounding makes of them for a ray that hits both triangles of an edge,
// where triangles are large and near. Of others that is asked (distance_from_edges) up to
// kAskedFromEdge.
inline constexpr float kNearEdge = 1e-5F, kAskedFromEdge = 1.0F / 128;

// Beyond what rounding does to distances of triangles that meet in a point: Embree leaves out hits
// that are a few roundings before the end of a ray.
inline float a_little_further(float distance) { return distance + std::abs(distance) * 1e-6F; }

// Barycentric, to the nearest of a triangle's edges.
inline float distance_from_edges(float u, float v) {
  return std::min(std::min(u, v), 1.0F - (u + v));
}

// How near to an edge, barycentric, a ray that hits a triangle may hit the next one as well, by
// rounding. `reach`: the length of the longest vector that is rounded on the way, from the ray's
// origin to the triangle and what a transform adds. Embree's error is that of the product of such a
// vector, the ray's direction and an edge, some ten roundings, over that of two edges and the
// direction: of a triangle that is seen as a sliver it is large. A neighbour some hundred times as
// large, and nearer than its own size, may pass rays from further off; that is not looked at.
inline float near_edge(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                       const glm::vec3& direction, float reach) {
  const glm::vec3 ab = b - a, ac = c - a, bc = c - b;
  const float longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  const float volume = std::abs(glm::dot(glm::cross(ab, ac), direction));
  constexpr float kRoundings = 8 * 0x1p-24F;  // three have been seen
  return std::max(
      kNearEdge, kRoundings * reach * std::sqrt(longest * glm::dot(direction, direction)) / volume);
}

// Which active rays have hits within kAskedFromEdge of an edge, and whether any has.
bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges);

}  // namespace delray::raytrace
