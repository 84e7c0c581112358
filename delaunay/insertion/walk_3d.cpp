// The stochastic visibility walk in a 3D triangulation and its ghosts (Devillers, Pion and Teillaud
// 2002): the facets of a tetrahedron are tried from a random one on, but not the one that the walk
// came through. Expected O(n^(1/3)) from anywhere. Degenerate: a point on a facet is in either
// simplex, one at a vertex is reported as equal.
#include <array>

#include "delaunay/insertion/facet_walk.h"
#include "delaunay/insertion/orientation_3d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/xorshift.h"

namespace delray::delaunay {

Place walk(const Mesh<3>& mesh, const Orientation<3>& orientation, SimplexNumber start,
           const glm::dvec3& q, std::uint32_t& random) {
  std::array<VertexNumber, 4> vertices;
  const SimplexNumber here =
      internal::walk_over_facets(mesh, start, [&](SimplexNumber simplex, unsigned entered) {
        for (unsigned k = 0; k < 4; ++k) vertices[k] = mesh.vertex(corner_of(simplex, k));
        return internal::exit_facet(internal::next_random(random), entered, [&](unsigned k) {
          return orientation.with(q, k, vertices) < 0;
        });
      });
  for (const VertexNumber vertex : vertices) {
    if (vertex != kInfiniteVertex && orientation.point(vertex) == q) return {here, vertex};
  }
  return {here, kInfiniteVertex};
}

}  // namespace delray::delaunay
