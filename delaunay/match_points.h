// Matching the vertices of a mesh with points, by their coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "delaunay/points.h"

namespace delray::delaunay {

// Which rows of the points the vertices of a mesh are.
struct PointMatch {
  // For each vertex the lowest row of the points with its coordinates 0 .. dim-1. Valid if the next
  // two are empty.
  std::vector<std::uint32_t> rows;
  std::optional<std::size_t> unknown;  // the first vertex that is none of the points
  // Two rows that are not equal, but both as the first vertex that is not one point alone.
  struct Ambiguity {
    std::size_t vertex;
    std::array<std::size_t, 2> rows;
  };
  std::optional<Ambiguity> ambiguous;
  std::size_t distinct = 0;  // points
  std::size_t unused = 0;    // distinct points that are no vertex
};

// Ways to compare vertices and points.
struct Matching {
  int dim = 2;             // 2 or 3; -0 equals 0
  bool as_floats = false;  // points are rounded to 32-bit floats before, vertices are such
  bool with_z = false;  // in 2D: z too, which tells points apart that rounding has brought together
};

// O(n) expected, parallel.
//
// REQUIRES: finite coordinates, three of each vertex and point; fewer than 2^32 - 1 of both
// together.
PointMatch match_points(PointView<double> vertices, PointView<double> points,
                        const Matching& matching);

}  // namespace delray::delaunay
