// CGAL's Delaunay_triangulation_3 over exact predicates and inexact constructions (GPL; here only).
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "delaunay/triangulation.h"

namespace delray::bench {

// Seconds from points in memory, in CGAL's own type, to CGAL's triangulation in memory, by
// inserting the whole range, which sorts it along a curve in random rounds.
double seconds_of_cgal3(std::span<const glm::dvec3> points);

#ifdef CGAL_LINKED_WITH_TBB
// The same with CGAL's parallel insertion and its lock grid. REQUIRES: threads >= 1.
double seconds_of_parallel_cgal3(std::span<const glm::dvec3> points, int threads);
#endif

// What CGAL makes of the points. Not meant to be timed.
delaunay::Triangulation triangulate_with_cgal3(std::span<const glm::dvec3> points);

}  // namespace delray::bench
