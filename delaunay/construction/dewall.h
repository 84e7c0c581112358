// Divide and conquer that merges first.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// The simplices that a plane crosses, the wall, are built first, by incremental construction; then
// what lies on its two sides, by threads of their own, each cut by a plane in turn. Nothing is
// merged (Cignoni, Montani and Scopigno 1998; Kohout 2004, 5.3.2). O(n log n) expected where points
// are spread evenly.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result dewall(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
