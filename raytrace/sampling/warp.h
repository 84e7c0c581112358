// From numbers in the unit square to points on discs and directions on spheres.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "shading/arithmetic.h"

namespace delray::raytrace {

// Uniform over the unit disc, neighbours staying neighbours (Shirley and Chiu 1997).
inline glm::vec2 disc_point(const glm::vec2& u) {
  const float x = 2.0F * u.x - 1.0F, y = 2.0F * u.y - 1.0F;
  if (x == 0.0F && y == 0.0F) return {0.0F, 0.0F};
  constexpr float kQuarter = 0.25F * shading::kPi;
  if (std::abs(x) > std::abs(y)) {
    const shading::SinCos angle = shading::sin_cos(kQuarter * (y / x));
    return {x * angle.cos, x * angle.sin};
  }
  const shading::SinCos angle = shading::sin_cos(kQuarter * (x / y));
  return {y * angle.sin, y * angle.cos};
}

// Unit vector around +z, density cos / pi. Never below the plane; in it with probability 2^-24 or
// so.
inline glm::vec3 cosine_direction(const glm::vec2& u) {
  const glm::vec2 d = disc_point(u);
  return {d.x, d.y, std::sqrt(std::max(0.0F, 1.0F - d.x * d.x - d.y * d.y))};
}

// Two unit vectors that make a right-handed frame (x, y, normal) with a unit normal (Duff et al.
// 2017).
struct Frame {
  glm::vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Frame() = default;
  explicit Frame(const glm::vec3& normal) : z(normal) {
    const float sign = std::copysign(1.0F, normal.z);
    const float a = -1.0F / (sign + normal.z), b = normal.x * normal.y * a;
    x = {1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    y = {b, sign + normal.y * normal.y * a, -normal.y};
  }
  glm::vec3 to_world(const glm::vec3& v) const { return x * v.x + y * v.y + z * v.z; }
  glm::vec3 to_local(const glm::vec3& v) const {
    return {glm::dot(x, v), glm::dot(y, v), glm::dot(z, v)};
  }
};

// How much of what one way of sampling finds with density `a` counts if another would have found it
// with density `b` (the power heuristic; Veach 1997). REQUIRES: a > 0, b >= 0.
inline float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1.0F / (1.0F + ratio * ratio);
}

}  // namespace delray::raytrace
