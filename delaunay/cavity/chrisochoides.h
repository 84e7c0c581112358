// Insertion by threads that have regions of the mesh.
#pragma once

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// One thread makes a coarse mesh, which is cut into a region for each; a thread inserts the points
// of its region, locks other regions that a cavity reaches into, and after each round regions are
// cut anew by what they have to do (Chrisochoides and Sukup 1996, Chrisochoides and Nave 1999;
// Kohout 2004, 5.2.1). Expected O(n log n) work.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_in_regions(PointView<double> points, const Options& options);

}  // namespace delray::delaunay::internal
