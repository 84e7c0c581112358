// The axes of a view from its direction.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace delray::scenes::internal {

struct Axes {
  glm::dvec3 right, up, forward;  // unit vectors at right angles
};

// Some axes rather than NaN where a vector has no length or both are parallel.
inline Axes axes_of(const glm::dvec3& to_target, const glm::dvec3& up_hint) {
  const auto normalized_or = [](const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
  };
  const glm::dvec3 forward = normalized_or(to_target, {0, 0, -1});
  glm::dvec3 side = glm::cross(forward, normalized_or(up_hint, {0, 1, 0}));
  if (glm::length(side) < 1e-6) {
    const bool along_z = std::abs(forward.z) > 0.9;
    side = glm::cross(forward, along_z ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1));
  }
  const glm::dvec3 right = glm::normalize(side);
  return {right, glm::cross(right, forward), forward};
}

}  // namespace delray::scenes::internal
