// The first simplex of a mesh and the ghosts around it.
#pragma once

#include <array>

#include "delaunay/mesh.h"

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

// In slots 0 to 4. REQUIRES: the tetrahedron is positively oriented.
inline void start_mesh(Mesh<3>& mesh, const std::array<VertexNumber, 4>& tetrahedron) {
  // Ghost 1 + k is the tetrahedron with infinity for corner k, and two others exchanged so that it
  // is positively oriented where infinity lies.
  const auto place = [](unsigned ghost, unsigned k) {
    const unsigned low = ghost < 2 ? 2 : 0, high = low + 1;
    return k == low ? high : k == high ? low : k;
  };
  for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(0, k), tetrahedron[k]);
  for (unsigned ghost = 0; ghost < 4; ++ghost) {
    for (unsigned k = 0; k < 4; ++k) {
      mesh.set_vertex(corner_of(1 + ghost, place(ghost, k)),
                      k == ghost ? kInfiniteVertex : tetrahedron[k]);
    }
    mesh.link(corner_of(1 + ghost, ghost), corner_of(0, ghost));
    for (unsigned other = 0; other < ghost; ++other) {
      mesh.link(corner_of(1 + ghost, place(ghost, other)),
                corner_of(1 + other, place(other, ghost)));
    }
  }
}

}  // namespace delray::delaunay::internal
