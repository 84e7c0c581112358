// Points of any dimension as the algorithms take them.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/dimensions/determinants.h"
#include "delaunay/points.h"

namespace delray::delaunay::internal {

// With -0 made equal to 0. Errors: std::invalid_argument for a view of too few coordinates, or that
// names the first row with a coordinate that is not finite.
template <int D>
std::vector<PlaceNd<D>> places_of(const PointView<double>& points);

// The lowest row of each place, in lexicographic order of places. O(n log n).
template <int D>
std::vector<std::uint32_t> distinct_rows(const std::vector<PlaceNd<D>>& places);

// The first D + 1 in order that span the space come to the front. False if there are none. Exact.
template <int D>
bool bring_spanning_to_front(const std::vector<PlaceNd<D>>& places,
                             std::vector<std::uint32_t>& rows);

}  // namespace delray::delaunay::internal
