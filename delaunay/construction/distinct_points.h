// Points as construction methods take them.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/insertion/insertion_start.h"
#include "delaunay/points.h"

namespace delray::delaunay::internal {

// Point i was row rows[i] of the input, the lowest of the rows that equal it. Neighbours in the
// order are near each other.
template <int D>
struct DistinctOrder {
  std::vector<Position<D>> points;
  std::vector<std::uint32_t> rows;
};

// O(n log n). Errors: std::invalid_argument that names the first row with a coordinate that is not
// finite.
template <int D>
DistinctOrder<D> distinct_points(PointView<double> input);

extern template DistinctOrder<2> distinct_points(PointView<double>);
extern template DistinctOrder<3> distinct_points(PointView<double>);

}  // namespace delray::delaunay::internal
