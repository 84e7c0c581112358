// The microscopic normals of a rough surface: GGX with Smith's shadowing, in a frame whose z is the
// surface's normal.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "shading/arithmetic.h"

namespace delray::shading {

// 1 + lambda along a direction at `cosine` with the normal: what it takes to see 1 of the surface.
inline float masking(float cosine, float a2) {
  return 0.5F + 0.5F * std::sqrt(1.0F + a2 * (1.0F / (cosine * cosine) - 1.0F));
}

// A normal as the viewer sees them (Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023).
// REQUIRES: view.z > 0; u and v from [0, 1).
inline glm::vec3 visible_normal(const glm::vec3& view, float alpha, float u, float v) {
  glm::vec3 stretched(alpha * view.x, alpha * view.y, view.z);
  stretched = stretched * (1.0F / std::sqrt(glm::dot(stretched, stretched)));
  const float z = (1.0F - v) * (1.0F + stretched.z) - stretched.z;
  const float sine = std::sqrt(std::max(0.0F, 1.0F - z * z));
  const SinCos phi = sin_cos(2.0F * kPi * u);
  const glm::vec3 sum = glm::vec3(sine * phi.cos, sine * phi.sin, z) + stretched;
  const glm::vec3 half(alpha * sum.x, alpha * sum.y, std::max(sum.z, 1e-7F));
  return half * (1.0F / std::sqrt(glm::dot(half, half)));
}

}  // namespace delray::shading
