// Insertion of many points at a time that do not meet.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Rounds: of the points in each simplex the one that comes first in a random order is a candidate;
// candidates whose cavities share nothing are inserted, all at once and without locks (Spielman,
// Teng and Ungor 2002; Kohout 2004, 5.2.3). Expected O(log n) rounds for points spread evenly.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_independent_sets(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
