// Bounding boxes and copies of points. A coordinate is finite if its difference to itself is 0,
// which is tested without a branch; only if some is not are the rows searched for the first such.
#include "delaunay/order/finite_points.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "delaunay/mesh/blocks.h"

namespace delray::delaunay::internal {

Box2d finite_box(const PointView<double>& points, int threads) {
  struct Bounds {
    Box2d box;
    bool finite = true;
  };
  const Blocks blocks(points.size(), threads);
  std::vector<Bounds> bounds(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    Bounds own;
    for (std::size_t row = first; row < last; ++row) {
      const glm::dvec2 p = point_at(points, row);
      own.box.include(p);
      own.finite &= p.x - p.x == 0 && p.y - p.y == 0;
    }
    bounds[block] = own;
  });
  Bounds all;
  for (const Bounds& own : bounds) {
    all.box.include(own.box);
    all.finite &= own.finite;
  }
  if (all.finite) return all.box;
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
