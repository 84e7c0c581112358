// Finding points with equal coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/points.h"

namespace delray::delaunay {

// For each row the lowest row with the same coordinates 0 .. dim-1; -0 equals 0. Rows are put
// into buckets by a hash, and each bucket goes through a small table that stays in the cache.
// O(n) expected, parallel.
//
// REQUIRES: dim is 2 or 3; finite coordinates; fewer than 2^32 - 1 points.
std::vector<std::uint32_t> lowest_equal_rows(PointView<double> points, int dim);

}  // namespace delray::delaunay
