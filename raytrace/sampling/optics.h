// Mirror and refraction directions.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace delray::raytrace {

// The unit direction into which light towards `view` was mirrored; both on the side of `normal`.
inline glm::vec3 mirrored(const glm::vec3& view, const glm::vec3& normal) {
  return normal * (2.0F * glm::dot(normal, view)) - view;
}

struct Refraction {
  float reflected = 1.0F;  // the fraction that is mirrored (Fresnel, unpolarised); 1: all of it is
  glm::vec3 direction{0.0F};
};

// Light towards `view` at an interface with `normal` on the viewer's side; `ratio` is the index of
// refraction on the viewer's side over that of the other.
inline Refraction refracted(const glm::vec3& view, const glm::vec3& normal, float ratio) {
  const float cosine = std::min(std::max(glm::dot(normal, view), 0.0F), 1.0F);
  const float squared = 1.0F - ratio * ratio * (1.0F - cosine * cosine);
  if (squared <= 0.0F) return {};  // total internal reflection
  const float other = std::sqrt(squared);
  const float parallel = (cosine - ratio * other) / (cosine + ratio * other);
  const float perpendicular = (ratio * cosine - other) / (ratio * cosine + other);
  return {0.5F * (parallel * parallel + perpendicular * perpendicular),
          normal * (ratio * cosine - other) - view * ratio};
}

// `direction` turned, if need be, to the side of `normal`: the shading normal may bend light
// through a surface that it should leave.
inline glm::vec3 kept_on_side(const glm::vec3& direction, const glm::vec3& normal) {
  constexpr float kLeast = 1e-3F;
  const float height = glm::dot(direction, normal);
  if (height >= kLeast) return direction;
  const glm::vec3 turned = direction + normal * (kLeast - height);
  return turned * (1.0F / std::sqrt(glm::dot(turned, turned)));
}

}  // namespace delray::raytrace
