// The pessimistic method: everything but the location in one critical section.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Every thread locates its points in the shared history, and enters the critical section to finish
// the location, subdivide and legalize (Kohout 2004, 7.6).
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_pessimistically(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
