// The stochastic visibility walk in a 3D triangulation and its ghosts (Devillers, Pion and Teillaud
// 2002): the facets of a tetrahedron are tried from a random one on, but not the one that the walk
// came through. Expected O(n^(1/3)) from anywhere. Degenerate: a point on a facet is in either
// simplex, one at a vertex is reported as equal.
#include <array>

#include "delaunay/insertion/orientation_3d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/xorshift.h"

namespace delray::delaunay {

Place walk(const Mesh<3>& mesh, const Orientation<3>& orientation, SimplexNumber start,
           const glm::dvec3& q, std::uint32_t& random) {
  SimplexNumber here = start;
  unsigned entered = 4;
  for (;;) {
    std::array<VertexNumber, 4> vertices;
    for (unsigned k = 0; k < 4; ++k) vertices[k] = mesh.vertex(corner_of(here, k));
    const std::uint32_t first = internal::next_random(random);
    unsigned exit = 4;
    for (unsigned i = 0; i < 4 && exit == 4; ++i) {
      const unsigned k = (first + i) & 3;
      if (k != entered && orientation.with(q, k, vertices) < 0) exit = k;
    }
    if (exit == 4) {
      for (const VertexNumber vertex : vertices) {
        if (vertex != kInfiniteVertex && orientation.point(vertex) == q) return {here, vertex};
      }
      return {here, kInfiniteVertex};
    }
    const CornerNumber next = mesh.neighbour(corner_of(here, exit));
    here = simplex_of(next);
    entered = next & 3;
  }
}

}  // namespace delray::delaunay
