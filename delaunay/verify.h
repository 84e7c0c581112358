// A verifier that trusts nobody: it shares nothing with the triangulations but the predicates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "delaunay/points.h"

namespace delray::delaunay {

// Each property includes those before it.
struct Verdict {
  bool valid = false;      // the simplices cover the convex hull of the points exactly once and use
                           // every distinct point
  bool delaunay = false;   // no circumsphere has a point inside
  bool canonical = false;  // of all Delaunay triangulations it is the one that the project
                           // promises, and of equal points the lowest row is the vertex
  std::optional<std::size_t> simplex;  // the first that breaks the first property which fails
  std::string reason;                  // one sentence about that; empty if canonical
  std::size_t distinct = 0;            // distinct points
};

// Checks triangles (`dim` 2) or tetrahedra (3), dim + 1 vertices each, exactly:
//
// - vertices are rows of `points`, and each simplex is positively oriented;
// - a facet is shared by two simplices at most, on either side of it, and the facets of one simplex
//   form one convex polygon or polyhedron. The number of simplices over a place is the winding
//   number of that boundary around it, so the simplices cover the hull exactly once, and a vertex
//   on a facet or in a simplex would show as a place that is covered twice (Mehlhorn et al. 1999);
// - every distinct point is a vertex of a simplex (of none, if all points are collinear or
//   coplanar);
// - for each inner facet the opposite vertex of the neighbour is not inside the circumsphere, from
//   which the Delaunay property follows (Delaunay 1934);
// - canonical: where it is on the circumsphere, it counts as outside when the dim + 2 points are
//   considered from the lexicographically largest down (Devillers and Teillaud 2011).
//
// A vertex may be any of several equal rows. Points may be any finite doubles. O(n) expected,
// parallel.
//
// Throws std::invalid_argument where `dim` is neither 2 nor 3, points have too few coordinates or
// vertices do not make whole simplices. REQUIRES: fewer than 2^32 - 1 points and corners.
Verdict verify_simplices(int dim, PointView<double> points,
                         std::span<const std::uint32_t> simplices);

// As verify_simplices() with `dim` 2.
Verdict verify_triangles(PointView<double> points, std::span<const std::uint32_t> triangles);

// Whether the simplices are some of the Delaunay triangulation that the project promises, as those
// within an outline are (refine.h): that is made, and verified as above before anything is looked
// up in it. The properties hold all or none. Orientation does not count. O(n log n).
//
// Throws as verify_simplices() and triangulate(); also where vertices are no rows.
Verdict verify_part(int dim, PointView<double> points, std::span<const std::uint32_t> simplices);

// The lowest row in which coordinates 0 .. dim-1 of two point sets differ (-0 equals 0), and be it
// that one of them ends there; none if they are equal. A mesh file brings its own vertices: they
// must be the points before its triangles say anything about these. O(n).
std::optional<std::size_t> first_different_row(PointView<double> vertices, PointView<double> points,
                                               int dim);

}  // namespace delray::delaunay
