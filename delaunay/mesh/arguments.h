// Arguments that cannot be, at the doors of the library: std::invalid_argument says which.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

inline void check_dim(int dim) {
  if (dim != 2 && dim != 3)
    throw std::invalid_argument("the dimension is 2 or 3, not " + std::to_string(dim));
}

// Whether a view can have `dim` coordinates a point.
template <class Scalar>
void check_view(const PointView<Scalar>& points, int dim) {
  check_dim(dim);
  if (points.count == 0) return;
  if (points.data == nullptr) {
    throw std::invalid_argument("a view of " + std::to_string(points.count) +
                                " points has no memory");
  }
  if (points.stride < static_cast<std::size_t>(dim) * sizeof(Scalar)) {
    throw std::invalid_argument("points that lie " + std::to_string(points.stride) +
                                " bytes apart do not have " + std::to_string(dim) +
                                " coordinates of " + std::to_string(sizeof(Scalar)) + " bytes");
  }
}

// Whether simplices have dim + 1 vertices each, which are rows below `rows`. O(vertices).
void check_simplices(int dim, std::span<const std::uint32_t> vertices, std::size_t rows);
inline void check_triangulation(const Triangulation& triangulation, std::size_t rows) {
  check_simplices(triangulation.dim, triangulation.vertices, rows);
}

// Whether all coordinates of a place are finite.
void check_place(const glm::dvec3& place);

// Whether attributes are there for all points or for none.
void check_attributes(const PointCloud& points);

// Whether there is a value for each of `rows` rows.
void check_values(std::size_t values, std::size_t rows);

}  // namespace delray::delaunay::internal
