// A triangulation as flat arrays: the mesh that the insertion methods work on.
//
// Simplex t has D + 1 corners; corner k of it has the number 4 t + k, in 2D and in 3D, so that one
// number names a simplex and one of its vertices, or the facet opposite that vertex. The neighbour
// of a corner is the corner that looks at it across the facet opposite to both.
//
// One vertex lies at infinity: every facet of the convex hull has a ghost simplex beyond it whose
// other vertices are the facet's, seen from outside. So every facet has two sides, and points
// outside the hull are inserted by the code that serves the others. Simplices are positively
// oriented, ghosts with the infinite vertex anywhere on the far side.
#pragma once

#include <cstddef>
#include <cstdint>

#include "delaunay/array.h"

namespace delray::delaunay {

using VertexNumber = std::uint32_t;
using CornerNumber = std::uint32_t;   // 4 * simplex + corner
using SimplexNumber = std::uint32_t;  // below 2^30

constexpr VertexNumber kInfiniteVertex = 0xffffffffU;
constexpr VertexNumber kDeadVertex = 0xfffffffeU;  // in corner 0 of a simplex that was retired
constexpr std::size_t kMaximumSimplices = std::size_t{1} << 30;

constexpr CornerNumber corner_of(SimplexNumber simplex, unsigned k) { return 4 * simplex + k; }
constexpr SimplexNumber simplex_of(CornerNumber corner) { return corner >> 2; }

template <int D>
class Mesh {
 public:
  static_assert(D == 2 || D == 3);
  static constexpr unsigned kCorners = D + 1;

  Mesh() = default;
  // `simplices` slots, contents undefined. REQUIRES: simplices <= kMaximumSimplices.
  explicit Mesh(std::size_t simplices) : slots_(simplices * kCorners) {}

  std::size_t size() const { return slots_.size() / kCorners; }
  // Drops the slots from `simplices` on.
  void shrink(std::size_t simplices) { slots_.shrink(simplices * kCorners); }

  VertexNumber vertex(CornerNumber corner) const { return slots_[slot(corner)].vertex; }
  CornerNumber neighbour(CornerNumber corner) const { return slots_[slot(corner)].neighbour; }
  void set_vertex(CornerNumber corner, VertexNumber vertex) {
    slots_[slot(corner)].vertex = vertex;
  }
  // Makes the facets opposite to two corners one.
  void link(CornerNumber a, CornerNumber b) {
    slots_[slot(a)].neighbour = b;
    slots_[slot(b)].neighbour = a;
  }

  bool is_ghost(SimplexNumber simplex) const {
    bool ghost = false;
    for (unsigned k = 0; k < kCorners; ++k) {
      ghost |= vertex(corner_of(simplex, k)) == kInfiniteVertex;
    }
    return ghost;
  }
  bool is_dead(SimplexNumber simplex) const { return vertex(corner_of(simplex, 0)) == kDeadVertex; }

 private:
  // Vertex and neighbour lie side by side: a step over a facet needs both.
  struct Slot {
    VertexNumber vertex;
    CornerNumber neighbour;
  };

  // Triangles are stored without gaps although their corners are numbered by fours.
  static constexpr std::size_t slot(CornerNumber corner) {
    return D == 3 ? corner : corner - (corner >> 2);
  }

  Array<Slot> slots_;
};

// The corners of a triangle counterclockwise after `corner`, and before it.
constexpr CornerNumber next_corner(CornerNumber corner) {
  return corner + 1 - 3 * ((corner >> 1) & 1);
}
constexpr CornerNumber previous_corner(CornerNumber corner) {
  return (corner & 3) == 0 ? corner + 2 : corner - 1;
}

}  // namespace delray::delaunay
