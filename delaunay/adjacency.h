// Adjacency of a triangulation: the neighbours of each simplex, the simplices at each vertex, and
// the convex hull that it ends at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Which simplices lie beside each other, and one at each point.
struct Adjacency {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // dim + 1 per simplex: the simplex across the facet opposite to its vertex i, or kNone beyond
  // the hull.
  std::vector<std::uint32_t> neighbours;
  // Per row: a simplex that has it as a vertex, or kNone.
  std::vector<std::uint32_t> simplex_at;
};

// O(n) expected, parallel. Throws std::invalid_argument unless vertices are below `rows` and make
// whole simplices. REQUIRES: fewer than 2^32 - 1 corners.
Adjacency adjacency(const Triangulation& triangulation, std::size_t rows);

// Both of the following throw std::invalid_argument for a row that does not exist, or an adjacency
// that is of another triangulation.
//
// The simplices around a vertex, in no particular order; none for a row that is no vertex. O(size
// of the result) in 2D, times its logarithm in 3D.
std::vector<std::uint32_t> simplices_around(const Triangulation& triangulation,
                                            const Adjacency& adjacency, std::uint32_t row);

// The rows that share an edge with a vertex, ascending.
std::vector<std::uint32_t> vertices_around(const Triangulation& triangulation,
                                           const Adjacency& adjacency, std::uint32_t row);

// The vertices on the convex hull, those within its edges and faces included. In 2D
// counterclockwise from the lowest row; in 3D ascending. None without simplices. O(n) expected.
//
// The facets themselves are what hull_facets() of write_mesh.h gives.
std::vector<std::uint32_t> hull_vertices(const Triangulation& triangulation);

// Connected sets of simplices that one thread made (Kohout 2004, 7.9): at best as many as there are
// threads. created_by[i] is the thread that made simplex i (Result::created_by). 0 for no
// simplices. O(n) expected.
//
// REQUIRES: a creator for each simplex; vertices are below `rows`.
std::uint64_t count_fragments(const Triangulation& triangulation,
                              std::span<const std::uint16_t> created_by, std::size_t rows);

}  // namespace delray::delaunay
