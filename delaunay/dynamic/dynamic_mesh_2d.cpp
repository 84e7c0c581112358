// Insertion and removal of a vertex in a 2D Delaunay mesh.
//
// An insertion walks to the triangle, subdivides it and flips edges (Lawson 1977). A removal
// collects the ring of triangles around the vertex and fills the hole with the Delaunay triangles
// of the ring's vertices (refill.h). O(d^2) for a removal with d neighbours.
//
// Degenerate: a removal that would leave only collinear vertices changes nothing and says so; a
// vertex of the hull has the infinite vertex in its ring.
#include "delaunay/dynamic/dynamic_mesh.h"
#include "delaunay/dynamic/refill.h"
#include "delaunay/flip/flip_2d.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/start_mesh.h"

namespace delray::delaunay::internal {

void DynamicMesh<2>::start(const std::array<VertexNumber, 3>& triangle) {
  slots_.restart(4);
  start_mesh(slots_.mesh(), triangle);
}

SimplexNumber DynamicMesh<2>::insert(std::span<const glm::dvec2> points, VertexNumber vertex,
                                     SimplexNumber near) {
  slots_.reserve(2);
  const Place place = walk(mesh(), points, near, points[vertex], random_);
  subdivide(slots_.mesh(), place.simplex, vertex, slots_, suspects_);
  legalize(slots_.mesh(), points, slots_, suspects_);
  return place.simplex;
}

std::optional<SimplexNumber> DynamicMesh<2>::remove(std::span<const glm::dvec2> points,
                                                    VertexNumber vertex, SimplexNumber near,
                                                    std::size_t others) {
  const Place place = walk(mesh(), points, near, points[vertex], random_);
  CornerNumber corner = corner_of(place.simplex, 0);
  while (mesh().vertex(corner) != vertex) corner = next_corner(corner);
  Ring ring = ring_around(mesh(), corner);
  link_ = ring.vertices;
  std::erase(link_, kInfiniteVertex);
  if (link_.size() == others && is_flat(ring, points)) return std::nullopt;
  std::vector<SimplexNumber> slots = ring.simplices;
  refill(slots_.mesh(), points, ring, slots);
  for (const SimplexNumber slot : slots) slots_.retire(slot);
  return ring.simplices.back();
}

}  // namespace delray::delaunay::internal
