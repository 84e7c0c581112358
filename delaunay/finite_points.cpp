#include "delaunay/internal/finite_points.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace delray::delaunay::internal {

Box2d finite_box(const PointView<double>& points) {
  Box2d box;
  bool finite = true;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const glm::dvec2 p = point_at(points, row);
    box.include(p);
    finite &= p.x - p.x == 0 && p.y - p.y == 0;
  }
  if (finite) return box;
  std::size_t row = 0;
  while (std::isfinite(points(row, 0)) && std::isfinite(points(row, 1))) ++row;
  throw std::invalid_argument("row " + std::to_string(row) +
                              " has a coordinate that is not finite");
}

std::vector<glm::dvec2> finite_points(const PointView<double>& points) {
  finite_box(points);
  std::vector<glm::dvec2> result(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) result[row] = point_at(points, row);
  return result;
}

}  // namespace delray::delaunay::internal
