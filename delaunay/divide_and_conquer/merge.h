// Joining two triangulations that a line separates.
#pragma once

#include <array>

#include "delaunay/divide_and_conquer/hull_mesh.h"
#include "delaunay/divide_and_conquer/merge_filter.h"

namespace delray::delaunay::internal {

// An end of the merge line: a common tangent of the two hulls.
struct Tangent {
  VertexNumber left, right;
  SimplexNumber ghost;
};

// Fills the space between two hulls from their lower common tangent to the upper one.
//
// An edge of a hull that the other hull sees has a ghost, and it becomes the triangle that fills
// the space before the edge: its infinite vertex is replaced by one of the other side. Edges that
// are not Delaunay any more are flipped away first, which turns the triangle behind into a ghost.
//
// The triangulation on the left of the line is given by the vertex of its hull closest to the line,
// that on the right likewise. Of any two points of both |dx| + |dy| is at most `extent`. `spare`
// and `spare` + 1 are free slots of the mesh, which become the ghosts of the tangents. Returns the
// lower tangent and the upper one. O(edges of the hulls along the merge line + edges that are made
// and removed).
std::array<Tangent, 2> merge(HullMesh hulls, const MergeFilter& filter, HullVertex from_left,
                             HullVertex from_right, double extent, SimplexNumber spare);

}  // namespace delray::delaunay::internal
