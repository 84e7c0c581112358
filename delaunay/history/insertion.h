// Incremental insertion with flips, one thread.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// The report's sequential algorithm with its DAG or a walk instead: find the simplex of the next
// point, subdivide it, flip until Delaunay (Kohout 2004, sections 6 and 8). Expected O(n log n) in
// a random or brio order; along the curve alone some inputs make it quadratic.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_all(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
