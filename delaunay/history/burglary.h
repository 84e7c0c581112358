// The burglary method (Kohout 2004, 7.7.2).
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Threads lock what they need, simplex by simplex; where waiting would close a circle a thread uses
// the simplices of the one that it would wait for, so that nothing is ever undone. What that left
// wrong is repaired at the end. As triangulate(); REQUIRES: options resolved for this method.
Result insert_by_burglary(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
