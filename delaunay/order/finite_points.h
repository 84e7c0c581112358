// The first two coordinates of points as algorithms want them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "delaunay/order/cells.h"
#include "delaunay/points.h"

namespace delray::delaunay::internal {

// Point `row`, with -0 made equal to 0 in every bit.
inline glm::dvec2 point_at(const PointView<double>& points, std::size_t row) {
  return {points(row, 0) + 0.0, points(row, 1) + 0.0};
}

// The bounding box. Errors: std::invalid_argument that names the first row with a coordinate that
// is not finite. Several threads are those of the arena that the caller is in.
Box2d finite_box(const PointView<double>& points, int threads = 1);

// All points, or the same error.
std::vector<glm::dvec2> finite_points(const PointView<double>& points);

}  // namespace delray::delaunay::internal
