// The Voronoi diagram, which is the dual of a Delaunay triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "delaunay/adjacency.h"
#include "delaunay/points.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Vertices and edges of a Voronoi diagram.
struct Voronoi {
  // Vertex i is the circumcentre of simplex i; z is 0 in 2D. Simplices on a common sphere have
  // theirs in the same place, to within rounding.
  std::vector<glm::dvec3> vertices;
  // Vertices at the ends of the edges between neighbours, the lower first: 2 per inner facet.
  std::vector<std::uint32_t> edges;
  // Edges that go to infinity, one per facet of the hull: where from, and the outward normal of
  // the facet, of length 1.
  std::vector<std::uint32_t> ray_starts;
  std::vector<glm::dvec3> ray_directions;
  // The vertices of the cell of row i are cells[cell_begin[i]] .. cells[cell_begin[i + 1] - 1]: in
  // 2D counterclockwise, an open cell from the ray on the right as seen from inside to the one on
  // the left; in 3D in no particular order. Empty for rows that are no vertex.
  std::vector<std::uint32_t> cell_begin, cells;
};

// In floating point: centres of almost flat simplices are inexact and may overflow. O(n) expected.
//
// Throws std::invalid_argument where the numbers of points, vertices and neighbours do not fit.
// REQUIRES: the triangulation is Delaunay, of these points; adjacency is its own.
Voronoi voronoi(PointView<double> points, const Triangulation& triangulation,
                const Adjacency& adjacency);

}  // namespace delray::delaunay
