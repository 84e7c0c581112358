// Delaunay triangulation as the lower hull of the points on a paraboloid, one dimension higher.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// By quick_hull.h, in the space of lifted points (Brown 1979; Kohout 2004, 4.4). Expected
// O(n log n) where points are spread evenly.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result lower_hull_of_lifted(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
