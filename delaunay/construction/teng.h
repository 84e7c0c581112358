// Incremental construction in rounds, every simplex made once.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// In a round all open facets get their simplices, each by the thread of its area; threads then tell
// each other what they made, so that none is made twice (Teng, Sullivan, Beichl and Puliti 1993;
// Kohout 2004, 5.1.1). Rounds are as many as facets that a way from the first simplex to the last
// crosses.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result teng(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
