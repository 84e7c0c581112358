// The first triangle of an insertion in the plane, and counting the distinct points of flat input.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// The first three points in order that turn, counterclockwise. None if all are equal or collinear.
inline std::optional<std::array<VertexNumber, 3>> first_triangle(
    std::span<const glm::dvec2> points) {
  const auto n = static_cast<VertexNumber>(points.size());
  VertexNumber second = 1;
  while (second < n && points[second] == points[0]) ++second;
  for (VertexNumber third = second + 1; third < n; ++third) {
    const int turn = orient2d(points[0], points[second], points[third]);
    if (turn > 0) return std::array{VertexNumber{0}, second, third};
    if (turn < 0) return std::array{VertexNumber{0}, third, second};
  }
  return std::nullopt;
}

inline std::uint64_t count_distinct(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return lexicographically_less(a, b); });
  return static_cast<std::uint64_t>(std::unique(points.begin(), points.end()) - points.begin());
}

}  // namespace delray::delaunay::internal
