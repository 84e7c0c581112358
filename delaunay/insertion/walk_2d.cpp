// The stochastic visibility walk in a 2D triangulation (Devillers, Pion and Teillaud 2002): the
// edges of a triangle are tried in random order, but not the one that the walk came through.
// Expected O(sqrt n) from anywhere. Degenerate: a point on an edge is in either triangle, one at a
// vertex is reported as equal, and one beyond the hull ends the walk in a ghost.
#include "delaunay/insertion/walk.h"

#include "delaunay/mesh/xorshift.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {
namespace {

constexpr CornerNumber kNowhere = 0xffffffffU;

// The corner of the infinite vertex, or kNowhere.
CornerNumber infinite_corner(const Mesh<2>& mesh, SimplexNumber simplex) {
  for (unsigned k = 0; k < 3; ++k) {
    if (mesh.vertex(corner_of(simplex, k)) == kInfiniteVertex) return corner_of(simplex, k);
  }
  return kNowhere;
}

}  // namespace

Place walk(const Mesh<2>& mesh, std::span<const glm::dvec2> points, SimplexNumber start,
           const glm::dvec2& q, std::uint32_t& random) {
  const CornerNumber infinite = infinite_corner(mesh, start);
  // The corner opposite the edge that was walked through: q is known to be on its side.
  CornerNumber opposite = infinite == kNowhere ? kNowhere : mesh.neighbour(infinite);
  SimplexNumber here = infinite == kNowhere ? start : simplex_of(opposite);
  // Out of a ghost the walk came without knowing the side.
  if (infinite != kNowhere) opposite = kNowhere;
  for (;;) {
    const CornerNumber first = corner_of(here, internal::next_random(random) % 3);
    CornerNumber corner = first;
    CornerNumber exit = kNowhere;
    do {
      if (corner != opposite) {
        const glm::dvec2& a = points[mesh.vertex(next_corner(corner))];
        const glm::dvec2& b = points[mesh.vertex(previous_corner(corner))];
        if (orient2d(a, b, q) < 0) {
          exit = corner;
          break;
        }
      }
      corner = next_corner(corner);
    } while (corner != first);
    if (exit == kNowhere) break;
    opposite = mesh.neighbour(exit);
    here = simplex_of(opposite);
    if (mesh.vertex(opposite) == kInfiniteVertex) return {here, kInfiniteVertex};
  }
  for (unsigned k = 0; k < 3; ++k) {
    const VertexNumber vertex = mesh.vertex(corner_of(here, k));
    if (points[vertex] == q) return {here, vertex};
  }
  return {here, kInfiniteVertex};
}

}  // namespace delray::delaunay
