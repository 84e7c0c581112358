// A quick test that most circumscribed balls of a tile pass.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "geometry/box.h"

namespace delray::delaunay {

// Whether the ball through the corners of a simplex certainly lies in the box with its surface, and
// not on its border. Answers no for some balls that do, but never yes for one that does not: the
// diameter is at most the distance of the first corner from the border. Without a division; some
// 25 operations in 2D, 60 in 3D.
//
// With s_i the sides from the first corner, the diameter is |N| / |det| for the numerators N and
// the determinant of Cramer's rule. Rounding: a determinant of sides no longer than l has terms
// that add up to no more than 2 l^2 in 2D and 6 l^3 in 3D, each numerator terms of 2 l^3 and 6 l^4,
// and no term takes more than 11 roundings (Higham 2002, chapter 3), so that kError = 128 of them
// cover the sums and the rounding of the bound itself.
template <int D>
bool is_deep(const std::array<glm::vec<D, double>, D + 1>& corners,
             const geometry::Box<glm::vec<D, double>>& box) {
  constexpr double kRoundOff = 0x1p-53, kError = 128 * kRoundOff;
  // Numerators below may have lost something to underflow.
  constexpr double kLeast = 1e-250;
  const auto& p = corners[0];
  double depth = std::min(p[0] - box.low[0], box.high[0] - p[0]);
  for (int k = 1; k < D; ++k) {
    depth = std::min(depth, std::min(p[k] - box.low[k], box.high[k] - p[k]));
  }
  if constexpr (D == 2) {
    const glm::dvec2 a = corners[1] - p, b = corners[2] - p;
    const double aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y;
    const double longest = std::max(aa, bb);
    const double det = std::abs(a.x * b.y - a.y * b.x) - kError * longest;
    const double x = b.y * aa - a.y * bb, y = a.x * bb - b.x * aa;
    const double n = std::sqrt(x * x + y * y) + kError * longest * std::sqrt(longest);
    return n > kLeast && depth * det > n * (1 + kError);
  } else {
    const glm::dvec3 a = corners[1] - p, b = corners[2] - p, c = corners[3] - p;
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c);
    const double longest = std::max({aa, bb, cc}), length = std::sqrt(longest);
    const glm::dvec3 bc = glm::cross(b, c);
    const double det = std::abs(glm::dot(a, bc)) - kError * longest * length;
    const glm::dvec3 v = bc * aa + glm::cross(c, a) * bb + glm::cross(a, b) * cc;
    const double n = std::sqrt(glm::dot(v, v)) + kError * longest * longest;
    return n > kLeast && depth * det > n * (1 + kError);
  }
}

}  // namespace delray::delaunay
