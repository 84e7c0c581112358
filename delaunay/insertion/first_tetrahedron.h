// The first tetrahedron of an insertion in space, and counting the distinct points of flat input.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

inline bool are_collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto flat = [&](int i, int j) {
    return orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}) == 0;
  };
  return flat(0, 1) && flat(1, 2) && flat(2, 0);
}

// The first four of n points in order that are not coplanar, positively oriented; point v is at(v).
// None if all are coplanar.
template <class At>
std::optional<std::array<VertexNumber, 4>> first_tetrahedron(std::size_t n, const At& at) {
  VertexNumber second = 1;
  while (second < n && at(second) == at(0)) ++second;
  VertexNumber third = second + 1;
  while (third < n && are_collinear(at(0), at(second), at(third))) ++third;
  for (VertexNumber fourth = third + 1; fourth < n; ++fourth) {
    const int sign = orient3d(at(0), at(second), at(third), at(fourth));
    if (sign > 0) return std::array{VertexNumber{0}, second, third, fourth};
    if (sign < 0) return std::array{VertexNumber{0}, third, second, fourth};
  }
  return std::nullopt;
}
inline std::optional<std::array<VertexNumber, 4>> first_tetrahedron(
    std::span<const glm::dvec3> points) {
  return first_tetrahedron(points.size(),
                           [&](VertexNumber v) -> const glm::dvec3& { return points[v]; });
}

inline std::uint64_t count_distinct(std::vector<glm::dvec3> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return lexicographically_less_3d(a, b); });
  return static_cast<std::uint64_t>(std::unique(points.begin(), points.end()) - points.begin());
}

}  // namespace delray::delaunay::internal
