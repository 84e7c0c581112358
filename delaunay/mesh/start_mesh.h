// The first simplex of a mesh and the ghosts around it.
#pragma once

#include <array>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// In slots 0 to 3. REQUIRES: the triangle turns left.
inline void start_mesh(Mesh<2>& mesh, const std::array<VertexNumber, 3>& triangle) {
  for (unsigned k = 0; k < 3; ++k) mesh.set_vertex(corner_of(0, k), triangle[k]);
  for (unsigned k = 0; k < 3; ++k) {
    const SimplexNumber ghost = 1 + k;
    mesh.set_vertex(corner_of(ghost, 0), triangle[(k + 2) % 3]);
    mesh.set_vertex(corner_of(ghost, 1), triangle[(k + 1) % 3]);
    mesh.set_vertex(corner_of(ghost, 2), kInfiniteVertex);
    mesh.link(corner_of(ghost, 2), corner_of(0, k));
    mesh.link(corner_of(ghost, 1), corner_of(1 + (k + 1) % 3, 0));
  }
}

// In slots 0 to 4, infinity in corner 3 of the ghosts. REQUIRES: the tetrahedron is positively
// oriented.
inline void start_mesh(Mesh<3>& mesh, const std::array<VertexNumber, 4>& tetrahedron) {
  // The other corners of facet k, seen from outside.
  constexpr std::array<std::array<unsigned, 3>, 4> kFacets = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  // Where corner k is in the ghost of facet f; the infinite vertex replaces f itself.
  const auto place = [&](unsigned f, unsigned k) {
    for (unsigned i = 0; i < 3; ++i) {
      if (kFacets[f][i] == k) return i;
    }
    return 3U;
  };
  for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(0, k), tetrahedron[k]);
  for (unsigned f = 0; f < 4; ++f) {
    for (unsigned i = 0; i < 3; ++i) {
      mesh.set_vertex(corner_of(1 + f, i), tetrahedron[kFacets[f][i]]);
    }
    mesh.set_vertex(corner_of(1 + f, 3), kInfiniteVertex);
    mesh.link(corner_of(1 + f, 3), corner_of(0, f));
    for (unsigned g = 0; g < f; ++g) {
      mesh.link(corner_of(1 + f, place(f, g)), corner_of(1 + g, place(g, f)));
    }
  }
}

}  // namespace delray::delaunay::internal
