// Local improvement: a triangulation that another program made becomes the Delaunay triangulation
// of its points by flips.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulate.h"
#include "delaunay/triangulation.h"
#include "delaunay/verify.h"

namespace delray::delaunay {

// What a flip must gain.
enum class Criterion : std::uint8_t { circle, angle };

// An entry of the table of criteria: when two simplices that share a facet are flipped.
struct CriterionChoice {
  std::string_view name;
  std::string_view description;
  Criterion criterion;
  std::vector<int> dims;
};

std::span<const CriterionChoice> criteria();

// The triangulation, and what was done to it.
struct Improved {
  // Of the simplices as they were given, but for their orientation. Unless they are valid, nothing
  // was done and the rest is empty.
  Verdict given;
  Triangulation triangulation;  // of equal points the lowest row is the vertex
  FlipCounts flips;
  std::uint64_t turned = 0;  // simplices that were given with negative orientation
  // Facets whose simplices break the criterion and that no flip can replace, in space; 0 means that
  // the result is the Delaunay triangulation.
  std::uint64_t blocked = 0;
  std::optional<std::size_t> first_blocked;  // a simplex of the result at one of them
};

// Flips until every facet fulfils the criterion or is blocked (Lawson 1972; Kohout 2004, 4.1).
//
// `Criterion::circle`: a facet goes when the circumsphere of one of its simplices holds the other's
// vertex, where points on it are told apart as everywhere. Each flip lowers the surface of the
// points on the perturbed paraboloid, so flips end. In the plane they end at the triangulation that
// triangulate() gives; in space a facet may be blocked (Joe 1989).
// `Criterion::angle`, in the plane: an edge goes when the smallest angle of its two triangles grows
// by that, compared exactly. The result is a Delaunay triangulation (Sibson 1978), and among points
// on a common circle the given choice stays.
//
// At most one flip for each pair of points in the plane, and O(n^2) in space; of triangulations
// that are nearly Delaunay O(n).
//
// Throws std::invalid_argument where the dimension is neither 2 nor 3 or the criterion does not
// serve it, points have too few coordinates or vertices do not make whole simplices.
Improved improve(PointView<double> points, const Triangulation& given,
                 Criterion criterion = Criterion::circle);

}  // namespace delray::delaunay
