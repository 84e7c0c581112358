// Checked points and the first simplex of an insertion, in either dimension.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/insertion/first_triangle.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/order/finite_points.h"
#include "delaunay/points.h"

namespace delray::delaunay::internal {

template <int D>
using Position = glm::vec<D, double, glm::defaultp>;

// All points with -0 made equal to 0. Errors: std::invalid_argument that names the first row with a
// coordinate that is not finite.
template <int D>
std::vector<Position<D>> positions(const PointView<double>& points) {
  if constexpr (D == 2) {
    return finite_points(points);
  } else {
    finite_range(points);
    std::vector<glm::dvec3> result(points.size());
    for (std::size_t row = 0; row < result.size(); ++row) {
      result[row] = {points(row, 0) + 0.0, points(row, 1) + 0.0, points(row, 2) + 0.0};
    }
    return result;
  }
}

// See first_triangle() and first_tetrahedron().
template <int D>
std::optional<std::array<VertexNumber, D + 1>> first_simplex(
    const std::vector<Position<D>>& points) {
  if constexpr (D == 2) {
    return first_triangle(points);
  } else {
    return first_tetrahedron(points);
  }
}

}  // namespace delray::delaunay::internal
