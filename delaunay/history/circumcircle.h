// The circum-circle method (Kohout 2004, 7.7.3).
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Threads insert points at the same time and lock nothing: a thread that needs a simplex waits
// while the point that another inserts lies inside its circumcircle. Circles of waiting threads are
// broken, and the result repaired, as in the burglary method. Each simplex costs a test for each
// other thread. As triangulate(); REQUIRES: resolved options.
Result insert_by_circles(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
