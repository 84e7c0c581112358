// Along a Hilbert curve, without the rows that equal a lower one.
#include "delaunay/construction/distinct_points.h"

#include <span>

#include "delaunay/insertion/insertion_order.h"
#include "delaunay/mesh/equal_points.h"

namespace delray::delaunay::internal {

template <int D>
DistinctOrder<D> distinct_points(PointView<double> input) {
  const std::vector<Position<D>> points = positions<D>(input);
  const std::vector<std::uint32_t> lowest = lowest_equal_rows(input, D);
  DistinctOrder<D> result;
  for (const std::uint32_t row :
       insertion_order(std::span<const Position<D>>(points), "hilbert", 1)) {
    if (lowest[row] != row) continue;
    result.points.push_back(points[row]);
    result.rows.push_back(row);
  }
  return result;
}

template DistinctOrder<2> distinct_points(PointView<double>);
template DistinctOrder<3> distinct_points(PointView<double>);

}  // namespace delray::delaunay::internal
