// Draws from a rectangle uniformly in solid angle (Urena et al. 2013), O(1).
//
// Degenerate: solid angles too small for the digits of their sum, and parallelograms that are no
// rectangles, are drawn from uniformly in area; a point in the plane has density 0.
#include "raytrace/sampling/rectangle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shading/arithmetic.h"

namespace delray::raytrace {
namespace {

using shading::kPi;

// The sum of four angles below is off by up to 1.6e-6: 2^-14 of this.
constexpr float kLeastSolidAngle = 0.03F;

// Cosine between edges up to which a parallelogram is a rectangle.
constexpr float kRightAngle = 1e-4F;

// A rectangle as it stands before the point it is seen from: x and y along its edges, at depth z <
// 0 (Urena et al. 2013).
struct Spherical {
  glm::vec3 x_axis, y_axis, z_axis;
  float x0, x1, y0, y1, z;
  float b0, b1, k, solid_angle;
};

float length(const glm::vec3& v) { return std::sqrt(glm::dot(v, v)); }

Spherical spherical(const Parallelogram& shape, const glm::vec3& from) {
  Spherical s{};
  const float u = length(shape.edge_u), v = length(shape.edge_v);
  s.x_axis = shape.edge_u * (1.0F / u);
  s.y_axis = shape.edge_v * (1.0F / v);
  s.z_axis = glm::cross(s.x_axis, s.y_axis);
  const glm::vec3 d = shape.corner - from;
  s.z = glm::dot(d, s.z_axis);
  if (s.z > 0.0F) {
    s.z_axis = -s.z_axis;
    s.z = -s.z;
  }
  s.x0 = glm::dot(d, s.x_axis);
  s.y0 = glm::dot(d, s.y_axis);
  s.x1 = s.x0 + u;
  s.y1 = s.y0 + v;
  // z components of the normals of the four planes through the point and an edge, and the angles
  // between neighbouring planes.
  const float z2 = s.z * s.z;
  const std::array<float, 4> n = {
      -s.y0 / std::sqrt(z2 + s.y0 * s.y0), s.x1 / std::sqrt(z2 + s.x1 * s.x1),
      s.y1 / std::sqrt(z2 + s.y1 * s.y1), -s.x0 / std::sqrt(z2 + s.x0 * s.x0)};
  float angle[4];
  for (int i = 0; i < 4; ++i) angle[i] = shading::acos(-n[i] * n[(i + 1) % 4]);
  s.b0 = n[0];
  s.b1 = n[2];
  s.k = 2.0F * kPi - angle[2] - angle[3];
  s.solid_angle = angle[0] + angle[1] - s.k;
  return s;
}

bool is_rectangle(const Parallelogram& shape) {
  const float along = glm::dot(shape.edge_u, shape.edge_v);
  const float squared = glm::dot(shape.edge_u, shape.edge_u) * glm::dot(shape.edge_v, shape.edge_v);
  return squared > 0.0F && along * along <= kRightAngle * kRightAngle * squared;
}

// By area: one steradian at distance d and an angle is d^2 / cos square units.
float area_pdf(const Parallelogram& shape, const glm::vec3& from, const glm::vec3& position) {
  const glm::vec3 normal = glm::cross(shape.edge_u, shape.edge_v);  // its length is the area
  const glm::vec3 way = position - from;
  const float distance2 = glm::dot(way, way);
  const float facing = std::abs(glm::dot(normal, way));
  if (!(facing > 0.0F)) return 0.0F;
  return distance2 * std::sqrt(distance2) / facing;
}

glm::vec3 sample_spherical(const Spherical& s, const glm::vec3& from, const glm::vec2& u) {
  const shading::SinCos a = shading::sin_cos(u.x * s.solid_angle + s.k);
  const float sine = std::copysign(std::max(std::abs(a.sin), 1e-7F), a.sin);
  const float fu = (a.cos * s.b0 - s.b1) / sine;
  const float cu = std::clamp(std::copysign(1.0F / std::sqrt(fu * fu + s.b0 * s.b0), fu),
                              -1.0F + 1e-6F, 1.0F - 1e-6F);
  const float x = std::clamp(-(cu * s.z) / std::sqrt(1.0F - cu * cu), s.x0, s.x1);
  const float d2 = x * x + s.z * s.z;
  const float h0 = s.y0 / std::sqrt(d2 + s.y0 * s.y0);
  const float h1 = s.y1 / std::sqrt(d2 + s.y1 * s.y1);
  const float h = h0 + u.y * (h1 - h0), h2 = h * h;
  const float y =
      std::clamp(h2 < 1.0F - 1e-6F ? h * std::sqrt(d2 / (1.0F - h2)) : s.y1, s.y0, s.y1);
  return from + s.x_axis * x + s.y_axis * y + s.z_axis * s.z;
}

}  // namespace

SurfacePoint sample(const Parallelogram& shape, const glm::vec3& from, const glm::vec2& u) {
  if (is_rectangle(shape)) {
    const Spherical s = spherical(shape, from);
    if (s.solid_angle > kLeastSolidAngle) {
      return {sample_spherical(s, from, u), 1.0F / s.solid_angle};
    }
  }
  const glm::vec3 position = shape.corner + shape.edge_u * u.x + shape.edge_v * u.y;
  return {position, area_pdf(shape, from, position)};
}

float pdf(const Parallelogram& shape, const glm::vec3& from, const glm::vec3& position) {
  if (is_rectangle(shape)) {
    const Spherical s = spherical(shape, from);
    if (s.solid_angle > kLeastSolidAngle) return 1.0F / s.solid_angle;
  }
  return area_pdf(shape, from, position);
}

}  // namespace delray::raytrace
