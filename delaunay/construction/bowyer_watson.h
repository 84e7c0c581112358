// Insertion by cavities in the plane, one thread.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Finds the triangle of the next point by a walk, removes all triangles whose circles hold the
// point and joins it to the border of the hole (Bowyer 1981, Watson 1981; Kohout 2004, 4.3).
// Expected O(n log n) in a random or brio order.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_by_holes(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
