// Points without duplicates in the order of a grid's cells: the first phase of dividing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/array.h"
#include "delaunay/order/cells.h"
#include "delaunay/points.h"

namespace delray::delaunay::internal {

// Up to so many points of one cell are in lexicographic order; it is cheaper to divide them by that
// than to make a grid for them.
constexpr std::size_t kSmallCell = 32;

// Point i of the order was row rows[i] of the input, the lowest of the rows equal to it. If a cell
// has more than kSmallCell points, they follow the order of a grid over their own bounding box, and
// so on.
struct CellOrder {
  Box2d box;
  Array<glm::dvec2> points;
  Array<std::uint32_t> rows;
};

// Points go to buckets, runs of cells with so few points that each is sorted in the cache. O(n)
// unless points lie in nested clusters whose sizes differ by more than 2^16. Uses little more than
// the 20 bytes a point of the result. Several threads are those of the arena that the caller is in.
//
// Errors: std::invalid_argument that names the first row with a coordinate that is not finite.
CellOrder cell_order(PointView<double> points, int threads = 1);

}  // namespace delray::delaunay::internal
