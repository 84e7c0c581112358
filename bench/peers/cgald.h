// CGAL's Delaunay_triangulation of any dimension over exact predicates (GPL; here only).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/triangulation.h"

namespace delray::bench {

// Seconds from points with 4 coordinates each, in CGAL's own type, to CGAL's triangulation in
// memory, by inserting the whole range, which sorts it.
double seconds_of_cgal4(std::span<const double> coordinates);

// The number of finite simplices and of facets of the hull, and the simplices as rows. Which of
// cospherical points' triangulations CGAL gives depends on their order. REQUIRES: distinct points.
delaunay::Triangulation triangulate_with_cgal4(std::span<const double> coordinates);

}  // namespace delray::bench
