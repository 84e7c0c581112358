// Directions to a parallelogram, drawn from a point.
#pragma once

#include <glm/glm.hpp>

namespace delray::raytrace {

// corner + s * edge_u + t * edge_v, 0 <= s, t <= 1.
struct Parallelogram {
  glm::vec3 corner{0.0F}, edge_u{0.0F}, edge_v{0.0F};
};

// A point of a parallelogram, and the density with which it is drawn, per steradian as seen from
// `from`; 0: none can be drawn, as `from` lies in its plane or it has no area.
struct SurfacePoint {
  glm::vec3 position{0.0F};
  float pdf = 0.0F;
};

// A rectangle that fills more than a small part of the view is drawn from uniformly in solid angle
// (Urena et al. 2013), anything else uniformly in area. Both numbers of `u` from [0, 1).
SurfacePoint sample(const Parallelogram& shape, const glm::vec3& from, const glm::vec2& u);

// The pdf with which `sample` draws the point of the shape at `position`.
float pdf(const Parallelogram& shape, const glm::vec3& from, const glm::vec3& position);

}  // namespace delray::raytrace
