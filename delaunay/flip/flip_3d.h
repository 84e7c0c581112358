// Insertion into tetrahedra by subdivision and flips (Joe 1991; Kohout 2004, 6.3 and 6.4), for
// finite tetrahedra and ghosts alike, and without flat ones.
//
// The sphere of a tetrahedron beyond the new vertex's star grows over the vertex as the vertex is
// lowered onto the paraboloid; the tetrahedron that this happens to first can be flipped, and the
// others wait until they can. So flips never get stuck before the triangulation is Delaunay
// (Edelsbrunner and Shah 1996). Ties of heights are broken by the perturbation of conflict.h, so
// that two of them fall together only if the new vertex is coplanar with the facet that they share:
// these are flipped together, four to four.
//
// Every operation replaces tetrahedra in the same way: child k of a tetrahedron has its corners but
// for corner k, where the other end of the new edges is. Going down a history relies on that.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/glm.hpp>
#include <initializer_list>
#include <vector>

#include "delaunay/flip/dag_access.h"
#include "delaunay/insertion/orientation_3d.h"
#include "delaunay/mesh/flip_counter.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// As conflict() of a mesh; `Simplices` is a Mesh<3> or a Dag<3>.
template <class Simplices>
bool conflict(const Simplices& simplices, const Orientation<3>& orientation, SimplexNumber simplex,
              const glm::dvec3& q) {
  std::array<const glm::dvec3*, 4> p;
  unsigned infinite = 4;
  for (unsigned k = 0; k < 4; ++k) {
    const VertexNumber vertex = simplices.vertex(corner_of(simplex, k));
    p[k] = vertex == kInfiniteVertex ? &q : &orientation.point(vertex);
    if (vertex == kInfiniteVertex) infinite = k;
  }
  const SphereTests& tests = orientation.tests();
  if (infinite == 4) return sphere_conflict(tests, *p[0], *p[1], *p[2], *p[3], q);
  const int side = tests.orient3d(*p[0], *p[1], *p[2], *p[3]);
  if (side != 0) return side > 0;
  return conflict(simplices, orientation,
                  simplex_of(simplices.neighbour(corner_of(simplex, infinite))), q);
}

// A tetrahedron with its corners in another order of the same orientation.
struct Turned {
  SimplexNumber simplex;
  std::array<VertexNumber, 4> vertices;
  std::array<CornerNumber, 4> outer;  // the neighbours

  CornerNumber across(VertexNumber vertex) const {
    unsigned k = 0;
    while (k < 3 && vertices[k] != vertex) ++k;
    return outer[k];
  }
};

// Inserts vertices into `Simplices`, which is a Mesh<3> or a Dag<3>, under a policy of access (see
// dag_access.h, and the same of a mesh).
template <class Simplices, class Access>
class Flips3d {
 public:
  // `suspects` holds corners of the vertex that is being inserted.
  Flips3d(Simplices& simplices, const Orientation<3>& orientation, Access& access,
          std::vector<CornerNumber>& suspects)
      : simplices_(simplices), orientation_(orientation), access_(access), suspects_(suspects) {}

  // Cuts a simplex that contains the vertex, its boundary included, with all that share the facet
  // or the edge that the vertex lies on, and appends what came of them to the suspects. Writes
  // nothing unless all is granted.
  //
  // REQUIRES: the simplex is acquired; the vertex is not equal to one of its vertices.
  Grant subdivide(SimplexNumber simplex, VertexNumber vertex);

  // Flips until no simplex of the vertex has a neighbour in conflict with it. Never kRetry. After
  // kRefused some suspects are left.
  Grant legalize();

  // Flips the facet opposite to a corner of a finite vertex that is in conflict with what lies
  // beyond, if it can be flipped. REQUIRES: alone; no suspects.
  void flip_facet(CornerNumber corner) {
    suspects_.push_back(corner);
    Turned near = turn(corner);
    flip(near, simplices_.neighbour(corner));
    suspects_.clear();
  }

 private:
  using Children = std::array<SimplexNumber, 4>;

  // With corner `last` as the last one.
  Turned turn(CornerNumber last) const {
    constexpr std::array<std::array<unsigned, 4>, 4> kEven = {
        {{1, 3, 2, 0}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 2, 3}}};
    Turned turned;
    turned.simplex = simplex_of(last);
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber corner = corner_of(turned.simplex, kEven[last & 3][k]);
      turned.vertices[k] = simplices_.vertex(corner);
      turned.outer[k] = simplices_.neighbour(corner);
    }
    return turned;
  }
  // The first three corners take the places of those before them.
  static void rotate(Turned& turned) {
    std::rotate(turned.vertices.begin(), turned.vertices.begin() + 1, turned.vertices.begin() + 3);
    std::rotate(turned.outer.begin(), turned.outer.begin() + 1, turned.outer.begin() + 3);
  }
  // The neighbour across corner 2 with corners 0 and 1 the same: the next around that edge.
  Turned next_around(const Turned& turned) const {
    Turned next = turn(turned.outer[2]);
    while (next.vertices[0] != turned.vertices[0]) rotate(next);
    return next;
  }

  // Children 0 to count - 1 of a simplex, linked to each other and to what lies across the corner
  // that each has lost.
  Children create(const Turned& turned, VertexNumber vertex, unsigned count) {
    Children children = {kNoSimplex, kNoSimplex, kNoSimplex, kNoSimplex};
    access_.reserve(count);
    for (unsigned k = 0; k < count; ++k) {
      std::array<VertexNumber, 4> vertices = turned.vertices;
      vertices[k] = vertex;
      children[k] = access_.create(vertices);
    }
    for (unsigned k = 0; k < count; ++k) {
      access_.link(turned.outer[k], corner_of(children[k], k));
      for (unsigned j = 0; j < k; ++j) link(corner_of(children[k], j), corner_of(children[j], k));
    }
    return children;
  }
  void link(CornerNumber a, CornerNumber b) {
    simplices_.set_neighbour(a, b);
    simplices_.set_neighbour(b, a);
  }
  Grant acquire_across(const Turned& turned, unsigned count) {
    for (unsigned k = 0; k < count; ++k) {
      const Grant grant = access_.acquire({simplex_of(turned.outer[k])});
      if (grant != Grant::kGranted) return grant;
    }
    return Grant::kGranted;
  }

  Grant subdivide_inside(SimplexNumber simplex, VertexNumber vertex);
  Grant subdivide_facet(CornerNumber opposite, VertexNumber vertex);
  Grant subdivide_edge(Turned first, VertexNumber vertex);

  // The last suspect is `near`, whose last corner is the new vertex, and it is in conflict with
  // what lies beyond. Drops the suspect if no flip is possible there for now: the one that makes it
  // possible makes another suspect beside the same simplex.
  Grant flip(Turned& near, CornerNumber beyond);
  Grant flip_2_3(const Turned& near, const Turned& far);
  Grant flip_3_2(const Turned& near, const Turned& far);
  Grant flip_4_4(const Turned& near, const Turned& far);
  void pop() { suspects_.pop_back(); }
  // Where a flip replaces another simplex of the new vertex, that one is no suspect any more.
  void forget(SimplexNumber simplex, VertexNumber vertex) {
    CornerNumber corner = corner_of(simplex, 0);
    while (simplices_.vertex(corner) != vertex) ++corner;
    std::erase(suspects_, corner);
  }
  void replace_suspect(const Children& children) {
    suspects_.pop_back();
    for (const SimplexNumber child : children) {
      if (child != kNoSimplex) suspects_.push_back(corner_of(child, 3));
    }
  }

  static constexpr SimplexNumber kNoSimplex = 0xffffffffU;  // equals kNoNode

  Simplices& simplices_;
  const Orientation<3>& orientation_;
  Access& access_;
  std::vector<CornerNumber>& suspects_;
};

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::subdivide(SimplexNumber simplex, VertexNumber vertex) {
  const Turned whole = turn(corner_of(simplex, 3));
  const glm::dvec3& q = orientation_.point(vertex);
  std::array<unsigned, 4> on = {};  // the corners whose opposite facets the vertex lies on
  unsigned count = 0;
  for (unsigned k = 0; k < 4; ++k) {
    if (orientation_.with(q, k, whole.vertices) == 0) on[count++] = k;
  }
  if (count == 0) return subdivide_inside(simplex, vertex);
  if (count == 1) return subdivide_facet(corner_of(simplex, on[0]), vertex);
  assert(count == 2);
  // The vertex lies on the edge between the two other corners, which become corners 0 and 1.
  Turned first = turn(corner_of(simplex, on[0]));
  const VertexNumber across = whole.vertices[on[1]];
  while (first.vertices[2] != across) rotate(first);
  return subdivide_edge(first, vertex);
}

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::subdivide_inside(SimplexNumber simplex, VertexNumber vertex) {
  const Turned whole = turn(corner_of(simplex, 3));
  const auto& outer = whole.outer;
  const Grant grant = access_.acquire(
      {simplex_of(outer[0]), simplex_of(outer[1]), simplex_of(outer[2]), simplex_of(outer[3])});
  if (grant != Grant::kGranted) return grant;
  const Children children = create(whole, vertex, 4);
  for (unsigned k = 0; k < 4; ++k) suspects_.push_back(corner_of(children[k], k));
  access_.retire(simplex, children);
  return Grant::kGranted;
}

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::subdivide_facet(CornerNumber opposite, VertexNumber vertex) {
  const Turned near = turn(opposite);
  Grant grant = access_.acquire({simplex_of(near.outer[3])});
  if (grant != Grant::kGranted) return grant;
  const Turned far = turn(near.outer[3]);
  grant = access_.acquire({simplex_of(near.outer[0]), simplex_of(near.outer[1]),
                           simplex_of(near.outer[2]), simplex_of(far.outer[0]),
                           simplex_of(far.outer[1]), simplex_of(far.outer[2])});
  if (grant != Grant::kGranted) return grant;
  const Children below = create(near, vertex, 3), above = create(far, vertex, 3);
  for (unsigned k = 0; k < 3; ++k) {
    unsigned j = 0;
    while (far.vertices[j] != near.vertices[k]) ++j;
    link(corner_of(below[k], 3), corner_of(above[j], 3));
    suspects_.push_back(corner_of(below[k], k));
    suspects_.push_back(corner_of(above[k], k));
  }
  access_.retire(near.simplex, below);
  access_.retire(far.simplex, above);
  return Grant::kGranted;
}

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::subdivide_edge(Turned first, VertexNumber vertex) {
  std::vector<Turned> ring = {first};
  for (;;) {
    const Grant grant = access_.acquire({simplex_of(ring.back().outer[2])});
    if (grant != Grant::kGranted) return grant;
    const Turned next = next_around(ring.back());
    if (next.simplex == first.simplex) break;
    ring.push_back(next);
  }
  for (const Turned& turned : ring) {
    const Grant grant = acquire_across(turned, 2);
    if (grant != Grant::kGranted) return grant;
  }
  std::vector<Children> children;
  for (const Turned& turned : ring) {
    children.push_back(create(turned, vertex, 2));
    for (unsigned k = 0; k < 2; ++k) suspects_.push_back(corner_of(children.back()[k], k));
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Children& next = children[(i + 1) % ring.size()];
    for (unsigned k = 0; k < 2; ++k) link(corner_of(children[i][k], 2), corner_of(next[k], 3));
  }
  for (std::size_t i = 0; i < ring.size(); ++i) access_.retire(ring[i].simplex, children[i]);
  return Grant::kGranted;
}

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::legalize() {
  while (!suspects_.empty()) {
    const CornerNumber suspect = suspects_.back();
    if constexpr (Access::kMayRetry) {
      if (!simplices_.is_leaf(simplex_of(suspect))) {
        pop();
        continue;
      }
    }
    const CornerNumber beyond = simplices_.neighbour(suspect);
    Grant grant = access_.acquire({simplex_of(beyond)});
    if (grant == Grant::kRefused) return grant;
    if (grant == Grant::kRetry) continue;
    const glm::dvec3& q = orientation_.point(simplices_.vertex(suspect));
    if (!conflict(simplices_, orientation_, simplex_of(beyond), q)) {
      pop();
      tell_kept(access_, simplex_of(beyond));
      continue;
    }
    Turned near = turn(suspect);
    grant = flip(near, beyond);
    if (grant == Grant::kRefused) return grant;
  }
  return Grant::kGranted;
}

template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::flip(Turned& near, CornerNumber beyond) {
  const Turned far = turn(beyond);
  // Whether the facets of `far` at the three edges of the common facet face the new vertex.
  int smallest = 1;
  unsigned facing = 0, at = 0;
  for (unsigned k = 0; k < 3; ++k) {
    std::array<VertexNumber, 4> vertices = near.vertices;
    vertices[k] = far.vertices[3];
    const int side = orientation_(vertices);
    if (side > 0) continue;
    smallest = side;
    at = k;
    ++facing;
  }
  if (facing == 0) return flip_2_3(near, far);
  if (facing > 1) {
    pop();
    return Grant::kGranted;
  }
  for (unsigned k = 2; k != at; k = (k + 1) % 3) rotate(near);
  return smallest < 0 ? flip_3_2(near, far) : flip_4_4(near, far);
}

// Facet (a, b, c) between `near` and `far` gives way to an edge from the new vertex to the one
// beyond.
template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::flip_2_3(const Turned& near, const Turned& far) {
  const Grant grant = access_.acquire({simplex_of(near.outer[0]), simplex_of(near.outer[1]),
                                       simplex_of(near.outer[2]), simplex_of(far.outer[0]),
                                       simplex_of(far.outer[1]), simplex_of(far.outer[2])});
  if (grant != Grant::kGranted) return grant;
  const Children children = create(near, far.vertices[3], 3);
  for (unsigned k = 0; k < 3; ++k) {
    access_.link(far.across(near.vertices[k]), corner_of(children[k], 3));
  }
  count_flip(access_, &FlipCounts::two_three);
  replace_suspect(children);
  access_.retire(near.simplex, children);
  access_.retire(far.simplex, children);
  return Grant::kGranted;
}

// Edge (0, 1) of `near`, if it has only three tetrahedra around it, gives way to a facet.
template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::flip_3_2(const Turned& near, const Turned& far) {
  const CornerNumber third_corner = near.outer[2];
  if (simplex_of(third_corner) != simplex_of(far.across(near.vertices[2]))) {
    pop();
    return Grant::kGranted;
  }
  Grant grant = access_.acquire({simplex_of(third_corner)});
  if (grant != Grant::kGranted) return grant;
  const Turned third = turn(third_corner);
  const VertexNumber a = near.vertices[0], b = near.vertices[1];
  grant = access_.acquire({simplex_of(near.outer[0]), simplex_of(near.outer[1]),
                           simplex_of(far.across(a)), simplex_of(far.across(b)),
                           simplex_of(third.across(a)), simplex_of(third.across(b))});
  if (grant != Grant::kGranted) return grant;
  const Children children = create(near, far.vertices[3], 2);
  for (unsigned k = 0; k < 2; ++k) {
    access_.link(third.across(near.vertices[k]), corner_of(children[k], 2));
    access_.link(far.across(near.vertices[k]), corner_of(children[k], 3));
  }
  count_flip(access_, &FlipCounts::three_two);
  replace_suspect(children);
  forget(third.simplex, near.vertices[3]);
  access_.retire(near.simplex, children);
  access_.retire(far.simplex, children);
  access_.retire(third.simplex, children);
  return Grant::kGranted;
}

// Edge (0, 1) of `near`, if it has only four tetrahedra around it, crosses the edge from the new
// vertex to the one beyond and gives way to it. Two of the four may be ghosts.
template <class Simplices, class Access>
Grant Flips3d<Simplices, Access>::flip_4_4(const Turned& near, const Turned& far) {
  const SimplexNumber near_side = simplex_of(near.outer[2]),
                      far_side = simplex_of(far.across(near.vertices[2]));
  Grant grant = access_.acquire({near_side, far_side});
  if (grant != Grant::kGranted) return grant;
  const Turned other_near = next_around(near), other_far = next_around(other_near);
  if (other_far.simplex != far_side) {
    pop();
    return Grant::kGranted;
  }
  const VertexNumber a = near.vertices[0], b = near.vertices[1];
  grant = access_.acquire({simplex_of(near.outer[0]), simplex_of(near.outer[1]),
                           simplex_of(far.across(a)), simplex_of(far.across(b)),
                           simplex_of(other_near.outer[0]), simplex_of(other_near.outer[1]),
                           simplex_of(other_far.outer[0]), simplex_of(other_far.outer[1])});
  if (grant != Grant::kGranted) return grant;
  // In `other_near` the new vertex is corner 2.
  const Children children = create(near, far.vertices[3], 2),
                 others = create(other_near, far.vertices[3], 2);
  for (unsigned k = 0; k < 2; ++k) {
    link(corner_of(children[k], 2), corner_of(others[k], 3));
    access_.link(far.across(near.vertices[k]), corner_of(children[k], 3));
    access_.link(other_far.outer[k], corner_of(others[k], 2));
  }
  const auto has_ghost = [](const Turned& turned) {
    return std::ranges::find(turned.vertices, kInfiniteVertex) != turned.vertices.end();
  };
  const bool is_flat = has_ghost(near) || has_ghost(far) || has_ghost(other_near);
  count_flip(access_, is_flat ? &FlipCounts::two_two : &FlipCounts::four_four);
  replace_suspect(children);
  forget(other_near.simplex, near.vertices[3]);
  for (unsigned k = 0; k < 2; ++k) suspects_.push_back(corner_of(others[k], 2));
  access_.retire(near.simplex, children);
  access_.retire(far.simplex, children);
  access_.retire(other_near.simplex, others);
  access_.retire(other_far.simplex, others);
  return Grant::kGranted;
}

}  // namespace delray::delaunay::internal
