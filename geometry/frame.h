// Orthonormal frames around a direction.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace delray::geometry {

// Three unit vectors at right angles, right-handed: cross(tangent, bitangent) = normal.
struct Frame {
  glm::vec3 tangent, bitangent, normal;

  glm::vec3 to_world(const glm::vec3& v) const {
    return tangent * v.x + bitangent * v.y + normal * v.z;
  }
  glm::vec3 to_local(const glm::vec3& v) const {
    return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)};
  }
};

// A frame whose normal is `normal`, continuous but for the sign of z (Duff et al. 2017).
//
// REQUIRES: `normal` has unit length.
inline Frame frame_around(const glm::vec3& normal) {
  const float sign = std::copysign(1.0F, normal.z);
  const float a = -1.0F / (sign + normal.z);
  const float b = normal.x * normal.y * a;
  return {{1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y},
          normal};
}

}  // namespace delray::geometry
