// Incremental construction, one simplex after the other.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Each facet whose outside is open gets the simplex that lies there, the facets of which are open
// then (McLain 1976; Dwyer 1991; Kohout 2004, 4.2). No simplex is ever changed. Points are found in
// buckets: O(n log n) expected where they are spread evenly, O(n^2) at worst in the plane.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result wrap_gifts(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
