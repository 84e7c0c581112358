// The optimistic method: every thread locks the simplices that it needs.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Every thread inserts its points into the shared history and locks each simplex before it touches
// it; what it has locked it keeps until the point is inserted, so insertions happen as if one after
// the other. A thread that must not wait undoes its insertion by a journal and tries again (Kohout
// 2004, 7.7.1); options.deadlocks says when that is.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_optimistically(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
