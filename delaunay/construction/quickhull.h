// Delaunay triangulation as the lower hull of the points on a paraboloid, one dimension higher.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Facets of the hull keep the points that lie outside of them; the farthest of one facet's is added
// next, and the points of the facets that it sees go to the new ones (Brown 1979; Barber, Dobkin
// and Huhdanpaa 1996; Kohout 2004, 4.4). Facets of the lower hull are simplices, those that stand
// upright the ghosts beyond the convex hull: a point is outside of one when it is in conflict with
// it, which is decided exactly. Expected O(n log n) where points are spread evenly.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result lower_hull_of_lifted(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
