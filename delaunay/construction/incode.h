// Incremental construction by threads that know all points and have an area each.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// A thread makes all simplices with a corner in its area; those that several make are found and
// removed at the end, by one thread (InCode: Cignoni, Laforenza, Perego, Scopigno and Montani 1995;
// Kohout 2004, 5.1.1). Expected O(n log n) work for points spread evenly.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result incode(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
