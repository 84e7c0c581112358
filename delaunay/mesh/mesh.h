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

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "delaunay/mesh/array.h"

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
  explicit Mesh(std::size_t simplices) : numbers_(2 * kCorners * simplices) {}

  std::size_t size() const { return numbers_.size() / (2 * kCorners); }
  // Makes room for `simplices` slots, the new ones undefined. O(size), old and new together in
  // memory. REQUIRES: size() <= simplices <= kMaximumSimplices.
  void grow(std::size_t simplices) {
    Array<std::uint32_t> larger(2 * kCorners * simplices);
    std::copy_n(numbers_.data(), numbers_.size(), larger.data());
    numbers_ = std::move(larger);
  }
  // Asks for a simplex that will be read soon.
  void prefetch(SimplexNumber simplex) const {
    __builtin_prefetch(numbers_.data() + place(corner_of(simplex, 0)));
  }
  // Drops the slots from `simplices` on.
  void shrink(std::size_t simplices) { numbers_.shrink(2 * kCorners * simplices); }

  VertexNumber vertex(CornerNumber corner) const { return numbers_[place(corner)]; }
  CornerNumber neighbour(CornerNumber corner) const { return numbers_[place(corner) + 1]; }
  void set_vertex(CornerNumber corner, VertexNumber vertex) { numbers_[place(corner)] = vertex; }
  // Makes the facets opposite to two corners one.
  void link(CornerNumber a, CornerNumber b) {
    numbers_[place(a) + 1] = b;
    numbers_[place(b) + 1] = a;
  }

  // The facet's other side alone, where that side's own link stands or is somebody else's to write.
  void set_neighbour(CornerNumber corner, CornerNumber neighbour) {
    numbers_[place(corner) + 1] = neighbour;
  }

  // Vertex and neighbour of corner k of a simplex, in fewer steps than by corner number.
  VertexNumber vertex(SimplexNumber simplex, unsigned k) const {
    return numbers_[place(simplex, k)];
  }
  CornerNumber neighbour(SimplexNumber simplex, unsigned k) const {
    return numbers_[place(simplex, k) + 1];
  }
  void set_vertex(SimplexNumber simplex, unsigned k, VertexNumber vertex) {
    numbers_[place(simplex, k)] = vertex;
  }
  void set_neighbour(SimplexNumber simplex, unsigned k, CornerNumber neighbour) {
    numbers_[place(simplex, k) + 1] = neighbour;
  }

  bool is_ghost(SimplexNumber simplex) const {
    bool ghost = false;
    for (unsigned k = 0; k < kCorners; ++k) {
      ghost |= vertex(corner_of(simplex, k)) == kInfiniteVertex;
    }
    return ghost;
  }
  bool is_dead(SimplexNumber simplex) const { return vertex(corner_of(simplex, 0)) == kDeadVertex; }

  // Forgets the simplices [first, last), whose memory goes back to the system as far as it came
  // from there.
  void discard(std::size_t first, std::size_t last) {
    numbers_.discard(2 * kCorners * first, 2 * kCorners * last);
  }

 private:
  // Vertex and neighbour lie side by side, since a step over a facet needs both. Triangles are
  // stored without gaps although their corners are numbered by fours.
  static constexpr std::size_t place(CornerNumber corner) {
    return 2 * std::size_t{D == 3 ? corner : corner - (corner >> 2)};
  }
  static constexpr std::size_t place(SimplexNumber simplex, unsigned k) {
    return 2 * (kCorners * std::size_t{simplex} + k);
  }

  Array<std::uint32_t> numbers_;
};

// The corners of a triangle counterclockwise after `corner`, and before it.
constexpr CornerNumber next_corner(CornerNumber corner) {
  return corner + 1 - 3 * ((corner >> 1) & 1);
}
constexpr CornerNumber previous_corner(CornerNumber corner) {
  return (corner & 3) == 0 ? corner + 2 : corner - 1;
}

}  // namespace delray::delaunay
