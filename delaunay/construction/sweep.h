// Delaunay triangulation by a sweep line.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// A line sweeps up over the points; the beach line below it consists of arcs of parabolas, each
// nearest to one point. A point splits an arc in two, and where an arc shrinks to nothing a
// triangle of the three points is ready (Fortune 1987; Kohout 2004, 4.4). O(n log n) for every
// input.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result sweep(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
