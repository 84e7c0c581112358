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

// Checks triangles, three vertices each, exactly:
//
// - vertices are rows of `points`, and each triangle turns left;
// - an edge is shared by two triangles at most, on either side of it, and the edges of one triangle
//   form one convex polygon. The number of triangles over a place is the winding number of the
//   polygon around it, so the triangles cover the hull exactly once, and a vertex on an edge or in
//   a triangle would show as a place that is covered twice (Mehlhorn et al. 1999);
// - every distinct point is a vertex of a triangle (of none, if all points are collinear);
// - for each inner edge the opposite vertex of the neighbour is not inside the circumcircle, from
//   which the Delaunay property follows (Delaunay 1934);
// - canonical: where it is on the circumcircle, it counts as outside when the four points are
//   considered from the lexicographically largest down (Devillers and Teillaud 2011).
//
// A vertex may be any of several equal rows. Points may be any finite doubles. O(n), parallel.
//
// REQUIRES: fewer than 2^32 - 1 points and triangle corners; triangles.size() is a multiple of 3.
Verdict verify_triangles(PointView<double> points, std::span<const std::uint32_t> triangles);

// The lowest row in which coordinates 0 .. dim-1 of two point sets differ (-0 equals 0), and be it
// that one of them ends there; none if they are equal. A mesh file brings its own vertices: they
// must be the points before its triangles say anything about these. O(n).
std::optional<std::size_t> first_different_row(PointView<double> vertices, PointView<double> points,
                                               int dim);

}  // namespace delray::delaunay
