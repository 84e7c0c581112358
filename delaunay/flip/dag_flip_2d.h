// Insertion into triangles by subdivision and flips (Lawson 1977) that leaves the history behind
// (Kohout 2004, 6), under a policy of access (dag_access.h).
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_access.h"
#include "delaunay/mesh/flip_counter.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/predicates/orientation.h"

namespace delray::delaunay::internal {

template <>
struct DagTriangulation<2> {
  Dag<2>& dag;
  std::span<const glm::dvec2> points;
  Orientation<2> orientation;
};

// As conflict() of a mesh.
inline bool conflict(const DagTriangulation<2>& triangulation, NodeNumber node,
                     const glm::dvec2& q) {
  std::array<const glm::dvec2*, 3> p;
  for (unsigned k = 0; k < 3; ++k) {
    const VertexNumber vertex = triangulation.dag.vertex(corner_of(node, k));
    p[k] = vertex == kInfiniteVertex ? nullptr : &triangulation.points[vertex];
  }
  for (unsigned k = 0; k < 3; ++k) {
    if (p[k] != nullptr) continue;
    const glm::dvec2 &a = *p[(k + 1) % 3], &b = *p[(k + 2) % 3];
    const int side = orient2d(a, b, q);
    return side != 0 ? side > 0 : strictly_between(a, b, q);
  }
  return circle_conflict(*p[0], *p[1], *p[2], q);
}

// Cuts a leaf into three around `vertex`, which is corner 2 of all three; they are appended to
// `suspects`. Writes nothing unless all is granted. REQUIRES: the leaf is acquired.
template <class Access>
[[gnu::flatten]] Grant subdivide(const DagTriangulation<2>& triangulation, NodeNumber leaf,
                                 VertexNumber vertex, Access& access,
                                 std::vector<NodeNumber>& suspects) {
  Dag<2>& dag = triangulation.dag;
  std::array<VertexNumber, 3> old;
  std::array<CornerNumber, 3> around;
  for (unsigned k = 0; k < 3; ++k) {
    old[k] = dag.vertex(corner_of(leaf, k));
    around[k] = dag.neighbour(corner_of(leaf, k));
  }
  const Grant grant =
      access.acquire({simplex_of(around[0]), simplex_of(around[1]), simplex_of(around[2])});
  if (grant != Grant::kGranted) return grant;
  if constexpr (Access::kMayRetry) {
    for (unsigned k = 0; k < 3; ++k) {
      if (dag.neighbour(corner_of(leaf, k)) != around[k]) return Grant::kRetry;
    }
  }
  std::array<NodeNumber, 3> children;
  access.reserve(3);
  for (unsigned k = 0; k < 3; ++k) {
    children[k] = access.create({old[(k + 1) % 3], old[(k + 2) % 3], vertex});
    suspects.push_back(children[k]);
  }
  for (unsigned k = 0; k < 3; ++k) {
    dag.set_neighbour(corner_of(children[k], 0), corner_of(children[(k + 1) % 3], 1));
    dag.set_neighbour(corner_of(children[k], 1), corner_of(children[(k + 2) % 3], 0));
    access.link(around[k], corner_of(children[k], 2));
  }
  access.retire(leaf, children);
  return Grant::kGranted;
}

// Cuts the leaf of `corner` and the one beyond into two each around `vertex`, which lies on the
// edge between them and is corner 2 of all four; they are appended to `suspects`. Where others may
// look in between operations this takes the place of subdivide(), which would leave them a flat
// triangle. Writes nothing unless all is granted. REQUIRES: the leaf of `corner` is acquired.
template <class Access>
Grant split_edge(const DagTriangulation<2>& triangulation, CornerNumber corner, VertexNumber vertex,
                 Access& access, std::vector<NodeNumber>& suspects) {
  Dag<2>& dag = triangulation.dag;
  const CornerNumber beyond = dag.neighbour(corner);
  const CornerNumber right = next_corner(corner), left = previous_corner(corner);
  const CornerNumber over_right = dag.neighbour(right), over_left = dag.neighbour(left);
  Grant grant = access.acquire({simplex_of(beyond), simplex_of(over_right), simplex_of(over_left)});
  if (grant != Grant::kGranted) return grant;
  const CornerNumber beyond_left = dag.neighbour(previous_corner(beyond)),
                     beyond_right = dag.neighbour(next_corner(beyond));
  grant = access.acquire({simplex_of(beyond_left), simplex_of(beyond_right)});
  if (grant != Grant::kGranted) return grant;
  if (dag.neighbour(corner) != beyond || dag.neighbour(right) != over_right ||
      dag.neighbour(left) != over_left || dag.neighbour(previous_corner(beyond)) != beyond_left ||
      dag.neighbour(next_corner(beyond)) != beyond_right) {
    return Grant::kRetry;
  }
  const VertexNumber near = dag.vertex(corner), far = dag.vertex(beyond);
  const VertexNumber first = dag.vertex(right), last = dag.vertex(left);
  // Counterclockwise around the vertex.
  access.reserve(4);
  const std::array<NodeNumber, 4> made = {
      access.create({last, near, vertex}), access.create({near, first, vertex}),
      access.create({first, far, vertex}), access.create({far, last, vertex})};
  const std::array<CornerNumber, 4> outside = {over_right, over_left, beyond_right, beyond_left};
  for (unsigned k = 0; k < 4; ++k) {
    const CornerNumber ahead = corner_of(made[k], 0), behind = corner_of(made[(k + 1) % 4], 1);
    dag.set_neighbour(ahead, behind);
    dag.set_neighbour(behind, ahead);
    access.link(outside[k], corner_of(made[k], 2));
    suspects.push_back(made[k]);
  }
  access.retire(simplex_of(corner), {made[0], made[1], kNoNode});
  access.retire(simplex_of(beyond), {made[2], made[3], kNoNode});
  return Grant::kGranted;
}

// Replaces the edge opposite `corner` by the one between its vertex and the vertex beyond, if that
// gives triangles that turn left. The vertex of `corner` becomes corner 2 of both new leaves, which
// replace the old ones in `made`. Writes nothing unless all is granted.
template <class Access>
Grant flip(const DagTriangulation<2>& triangulation, CornerNumber corner, Access& access,
           std::array<NodeNumber, 2>& made) {
  Dag<2>& dag = triangulation.dag;
  const CornerNumber beyond = dag.neighbour(corner);
  const CornerNumber right = next_corner(corner), left = previous_corner(corner);
  // Right of the corner lies its triangle's next vertex, which is the one before `beyond`.
  const CornerNumber over_right = dag.neighbour(right), over_left = dag.neighbour(left);
  const CornerNumber beyond_left = dag.neighbour(previous_corner(beyond)),
                     beyond_right = dag.neighbour(next_corner(beyond));
  const Grant grant = access.acquire({simplex_of(over_right), simplex_of(over_left),
                                      simplex_of(beyond_left), simplex_of(beyond_right)});
  if (grant != Grant::kGranted) return grant;
  if constexpr (Access::kMayRetry) {
    if (dag.neighbour(previous_corner(beyond)) != beyond_left ||
        dag.neighbour(next_corner(beyond)) != beyond_right) {
      return Grant::kRetry;
    }
  }
  const VertexNumber near = dag.vertex(corner), far = dag.vertex(beyond);
  const VertexNumber first = dag.vertex(right), last = dag.vertex(left);
  access.reserve(2);
  made = {access.create({first, far, near}), access.create({far, last, near})};
  dag.set_neighbour(corner_of(made[0], 0), corner_of(made[1], 1));
  dag.set_neighbour(corner_of(made[1], 1), corner_of(made[0], 0));
  access.link(over_left, corner_of(made[0], 1));
  access.link(over_right, corner_of(made[1], 0));
  access.link(beyond_right, corner_of(made[0], 2));
  access.link(beyond_left, corner_of(made[1], 2));
  access.retire(simplex_of(corner), {made[0], made[1], kNoNode});
  access.retire(simplex_of(beyond), {made[0], made[1], kNoNode});
  return Grant::kGranted;
}

// Flips until no leaf of the new vertex has a neighbour in conflict with it; `suspects` are such
// leaves, the vertex in corner 2. Never kRetry. After kRefused some are left.
template <class Access>
[[gnu::flatten]] Grant legalize(const DagTriangulation<2>& triangulation, Access& access,
                                std::vector<NodeNumber>& suspects) {
  const Dag<2>& dag = triangulation.dag;
  while (!suspects.empty()) {
    const NodeNumber suspect = suspects.back();
    if constexpr (Access::kMayRetry) {
      if (!dag.is_leaf(suspect)) {
        suspects.pop_back();
        continue;
      }
    }
    const CornerNumber corner = corner_of(suspect, 2);
    const VertexNumber vertex = dag.vertex(corner);
    const CornerNumber beyond = dag.neighbour(corner);
    Grant grant = access.acquire({simplex_of(beyond)});
    if (grant == Grant::kRefused) return grant;
    if (grant == Grant::kRetry) continue;
    if constexpr (Access::kMayRetry) {
      if (dag.neighbour(corner) != beyond) continue;
    }
    bool flips = conflict(triangulation, simplex_of(beyond), triangulation.points[vertex]);
    if constexpr (Access::kMayRetry) {
      // Beside an unfinished insertion of another thread circles are no proof of anything.
      const VertexNumber first = dag.vertex(next_corner(corner)),
                         last = dag.vertex(previous_corner(corner)), far = dag.vertex(beyond);
      flips = flips && far != vertex &&
              triangulation.orientation.of_vertices(first, far, vertex) > 0 &&
              triangulation.orientation.of_vertices(far, last, vertex) > 0;
    }
    if (!flips) {
      suspects.pop_back();
      tell_kept(access, simplex_of(beyond));
      continue;
    }
    std::array<NodeNumber, 2> made{};
    grant = flip(triangulation, corner, access, made);
    if (grant == Grant::kRefused) return grant;
    if (grant == Grant::kRetry) continue;
    count_flip(access, &FlipCounts::two_two);
    suspects.back() = made[0];
    suspects.push_back(made[1]);
  }
  return Grant::kGranted;
}

}  // namespace delray::delaunay::internal
