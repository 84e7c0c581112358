// CGAL's Delaunay_triangulation_2 over exact predicates and inexact constructions (GPL; here only).
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "delaunay/triangulation.h"

namespace delray::bench {

// Seconds from points in memory, in CGAL's own type, to CGAL's triangulation in memory, by
// inserting the whole range, which sorts it along a curve in random rounds.
double seconds_of_cgal2(std::span<const glm::dvec3> points);

// What CGAL makes of the first two coordinates. Not meant to be timed.
delaunay::Triangulation triangulate_with_cgal2(std::span<const glm::dvec3> points);

}  // namespace delray::bench
