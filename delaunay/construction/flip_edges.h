// Local improvement of a triangulation in the plane.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// Flips edges whose two triangles' circles hold each other's third corner, until there is none:
// the Delaunay triangulation (Lawson 1972; Kohout 2004, 4.1). Returns the number of flips, at most
// that of pairs of points. Edges with a ghost on one side are the hull's and stay.
//
// REQUIRES: the finite triangles fill the convex hull of the points.
std::uint64_t flip_to_delaunay(Mesh<2>& mesh, std::span<const glm::dvec2> points);

// Flips edges whose two triangles get a larger smallest angle by it, until there is none (Lawson
// 1977). Among points on a common circle all edges are alike, and what is there stays.
//
// REQUIRES: the finite triangles fill the convex hull of the points.
std::uint64_t flip_to_largest_angles(Mesh<2>& mesh, std::span<const glm::dvec2> points);

}  // namespace delray::delaunay::internal
