// The mesh that divide and conquer works on: triangulated ranges of points, each within a hull of
// ghosts.
#pragma once

#include <glm/glm.hpp>

#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

constexpr SimplexNumber kNoGhost = 0xffffffffU;

// A vertex of a hull, and the ghost of the edge that starts there (none for a single point).
struct HullVertex {
  VertexNumber vertex;
  SimplexNumber ghost;
};

// Every ghost keeps its infinite vertex in corner 2: corners 0 and 1 are the end and the start of
// an edge of the hull, counterclockwise about the points, neighbour 0 is the ghost of the edge
// before it and neighbour 1 that of the edge after it.
struct HullMesh {
  const glm::dvec2* points;  // of all vertices
  Mesh<2>& mesh;

  void set_triangle(SimplexNumber t, VertexNumber a, VertexNumber b, VertexNumber c) const {
    mesh.set_vertex(t, 0, a);
    mesh.set_vertex(t, 1, b);
    mesh.set_vertex(t, 2, c);
  }
  // The ghost of the edge of the hull from a to b.
  void set_ghost(SimplexNumber t, VertexNumber a, VertexNumber b) const {
    set_triangle(t, b, a, kInfiniteVertex);
  }
  // Makes the facets opposite to corner k of t and to `other` one.
  void link(SimplexNumber t, unsigned k, CornerNumber other) const {
    mesh.set_neighbour(t, k, other);
    mesh.set_neighbour(other, corner_of(t, k));
  }
  void follow(SimplexNumber ghost, SimplexNumber next) const {
    mesh.set_neighbour(ghost, 1, corner_of(next, 0));
    mesh.set_neighbour(next, 0, corner_of(ghost, 1));
  }
  SimplexNumber next_ghost(SimplexNumber ghost) const {
    return simplex_of(mesh.neighbour(ghost, 1));
  }
  SimplexNumber previous_ghost(SimplexNumber ghost) const {
    return simplex_of(mesh.neighbour(ghost, 0));
  }
};

}  // namespace delray::delaunay::internal
