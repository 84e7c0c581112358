// Divide and conquer in 2D.
#pragma once

#include "delaunay/mesh/built_mesh.h"
#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Triangulates halves of the points on either side of a line and merges them (Guibas and
// Stolfi 1985), with ghost triangles for the hulls (Shewchuk 1996). Lines alternate between the
// axes, so that merge lines are short (Dwyer 1987), and are the edges of the cells of a
// grid, so that a radix sort finds all of them. O(n) expected for points of bounded density, O(n)
// times the depth of the cells otherwise; no input makes it quadratic.
//
// Errors: see triangulate().
Result divide_and_conquer(PointView<double> points, const Options& options);
// The mesh before it is copied out.
BuiltMesh<2> divide_and_conquer_mesh(PointView<double> points, const Options& options);

// As published first: all lines are vertical (Guibas and Stolfi 1985), so that merge lines are long
// and there are more of the edges that a later merge removes. O(n log n).
Result guibas_stolfi(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
