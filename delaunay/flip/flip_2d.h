// Insertion by subdivision and flips (Lawson 1977), for finite triangles and ghosts alike.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/mesh/flip_counter.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// Cuts `simplex` into three around `vertex`. The corner of the new vertex is corner 2 in all three,
// which are returned by the numbers of those corners, and appended to `suspects`.
//
// A vertex on an edge makes one of them flat; since the neighbour over that edge is in conflict
// with the vertex, legalize() flips it away. Returns false, having written nothing, if access is
// refused.
template <class Access>
bool subdivide(Mesh<2>& mesh, SimplexNumber simplex, VertexNumber vertex, Access& access,
               std::vector<CornerNumber>& suspects) {
  const CornerNumber around[3] = {mesh.neighbour(corner_of(simplex, 0)),
                                  mesh.neighbour(corner_of(simplex, 1)),
                                  mesh.neighbour(corner_of(simplex, 2))};
  if (!access.acquire(simplex)) return false;
  for (const CornerNumber corner : around) {
    if (!access.acquire(simplex_of(corner))) return false;
  }
  const VertexNumber a = mesh.vertex(corner_of(simplex, 0)), b = mesh.vertex(corner_of(simplex, 1)),
                     c = mesh.vertex(corner_of(simplex, 2));
  const SimplexNumber over_a = access.create(), over_b = access.create(), over_c = simplex;
  const auto set = [&](SimplexNumber t, VertexNumber first, VertexNumber second,
                       CornerNumber outside) {
    mesh.set_vertex(corner_of(t, 0), first);
    mesh.set_vertex(corner_of(t, 1), second);
    mesh.set_vertex(corner_of(t, 2), vertex);
    mesh.link(corner_of(t, 2), outside);
    suspects.push_back(corner_of(t, 2));
  };
  set(over_a, b, c, around[0]);
  set(over_b, c, a, around[1]);
  set(over_c, a, b, around[2]);
  mesh.link(corner_of(over_a, 0), corner_of(over_b, 1));
  mesh.link(corner_of(over_b, 0), corner_of(over_c, 1));
  mesh.link(corner_of(over_c, 0), corner_of(over_a, 1));
  return true;
}

// Replaces the edge opposite `corner` by the one from the vertex of `corner` to the vertex beyond.
// Afterwards `corner` and the returned corner are those of that vertex in the two triangles.
inline CornerNumber flip(Mesh<2>& mesh, CornerNumber corner) {
  const CornerNumber beyond = mesh.neighbour(corner);
  const CornerNumber right = next_corner(corner), left = previous_corner(corner);
  const CornerNumber beyond_right = previous_corner(beyond), beyond_left = next_corner(beyond);
  const VertexNumber near = mesh.vertex(corner), far = mesh.vertex(beyond);
  const VertexNumber kept = mesh.vertex(left);
  const CornerNumber outside_near = mesh.neighbour(right);        // over near and left
  const CornerNumber outside_far = mesh.neighbour(beyond_right);  // over far and left
  // This triangle becomes near, right, far; the other far, left, near.
  mesh.set_vertex(left, far);
  mesh.set_vertex(beyond_right, near);
  mesh.set_vertex(beyond_left, kept);
  mesh.link(corner, mesh.neighbour(beyond_left));
  mesh.link(right, beyond_left);
  mesh.link(beyond, outside_near);
  mesh.link(beyond_right, outside_far);
  return beyond_right;
}

// Flips until no triangle of the new vertex has a neighbour in conflict with it. `suspects` are
// corners of that vertex; none are left. Returns the number of flips, or -1 if access was refused
// in the middle, with the mesh valid but not Delaunay and the rest in `suspects`.
template <class Access>
int legalize(Mesh<2>& mesh, std::span<const glm::dvec2> points, Access& access,
             std::vector<CornerNumber>& suspects) {
  int flips = 0;
  while (!suspects.empty()) {
    const CornerNumber corner = suspects.back();
    const SimplexNumber across = simplex_of(mesh.neighbour(corner));
    if (!access.acquire(across)) return -1;
    suspects.pop_back();
    if (!conflict(mesh, points, across, points[mesh.vertex(corner)])) continue;
    suspects.push_back(flip(mesh, corner));
    suspects.push_back(corner);
    count_flip(access, &FlipCounts::two_two);
    ++flips;
  }
  return flips;
}

}  // namespace delray::delaunay::internal
