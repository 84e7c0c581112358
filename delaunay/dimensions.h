// Delaunay triangulations in up to six dimensions.
#pragma once

#include <cstdint>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "parallel/progress.h"

namespace delray::delaunay {

inline constexpr int kMostDimensions = 6;

// The triangulation by the rule of predicates/conflict.h, of points with `dim` coordinates each,
// dim from 2 to kMostDimensions; of equal points the lowest row represents, -0 equals 0. In 2D and
// 3D the simplices are those of triangulate(), which is faster. No simplices if the points do not
// span the space.
//
// Cavities (Bowyer 1981, Watson 1981), one thread; exact determinants of any dimension decide where
// doubles do not. O(n^ceil(dim / 2)) at worst, which points on a curve reach; of uniform points the
// simplices of a vertex are 6, 27, 150, 10^3 and 8 * 10^3 for 2 to 6 dimensions. `seed` decides
// about the order of insertion.
//
// Errors: std::invalid_argument for a dimension, a coordinate that is not finite (names the row) or
// more than 2^28 simplices; parallel::Interrupted by `progress`, which is advanced by the number of
// points, not started.
Triangulation triangulate_dimensions(PointView<double> points, int dim, std::uint64_t seed = 1,
                                     parallel::Progress* progress = nullptr);

}  // namespace delray::delaunay
