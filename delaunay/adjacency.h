// Which simplices of a triangulation lie beside which, and around which vertices.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

struct Adjacency {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // dim + 1 per simplex: the simplex across the facet opposite to its vertex i, or kNone beyond
  // the hull.
  std::vector<std::uint32_t> neighbours;
  // Per row: a simplex that has it as a vertex, or kNone.
  std::vector<std::uint32_t> simplex_at;
};

// O(n) expected, parallel. REQUIRES: vertices are below `rows`; fewer than 2^32 - 1 corners.
Adjacency adjacency(const Triangulation& triangulation, std::size_t rows);

// The simplices around a vertex, in no particular order; none for a row that is no vertex. O(size
// of the result) in 2D, times its logarithm in 3D.
std::vector<std::uint32_t> simplices_around(const Triangulation& triangulation,
                                            const Adjacency& adjacency, std::uint32_t row);

// The rows that share an edge with a vertex, ascending.
std::vector<std::uint32_t> vertices_around(const Triangulation& triangulation,
                                           const Adjacency& adjacency, std::uint32_t row);

}  // namespace delray::delaunay
