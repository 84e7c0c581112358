// Which facets of simplices lie on which: the adjacency of a list of simplices, from nothing but
// their vertex numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace delray::delaunay {

// Facet number simplex * (dim + 1) + i is the one opposite to vertex i of the simplex.
struct FacetMates {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> mates;  // the facet with the same vertices, or kNone
  std::uint32_t crowded = kNone;     // the lowest facet that is shared by three or more; no mates
};

// O(n) expected, parallel.
//
// REQUIRES: dim is 2 or 3; simplices.size() is a multiple of dim + 1 and below 2^32 - 1; vertices
// are below `points`.
FacetMates match_facets(int dim, std::span<const std::uint32_t> simplices, std::size_t points);

// The corners of the facet opposite to corner `opposite` of a positively oriented simplex, so that
// the simplex lies to their left (2D) or they are seen counterclockwise from outside (3D).
// REQUIRES: dim is 2 or 3; opposite <= dim.
std::span<const int> facet_corners(int dim, std::size_t opposite);

}  // namespace delray::delaunay
