// When a point destroys a simplex, and how simplices with the infinite vertex are oriented. Nothing
// else knows about ghosts and about points on a common circle.
//
// Ties are broken by lifting: every point is raised onto the paraboloid and then by an
// infinitesimal amount that falls with its place in lexicographic order (Devillers and Teillaud
// 2011). So the triangulation is unique: it does not depend on the order in which points arrive.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {

inline bool lexicographically_less(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// Whether q counts as inside the circle through a, b, c, on which it lies.
//
// The lexicographically largest of the four is raised most. If it is q, q is outside; otherwise
// raising it turns the plane through the other two about them, towards q or away from it.
// REQUIRES: a, b, c turn left; incircle(a, b, c, q) == 0; q is none of them.
inline bool cocircular_inside(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                              const glm::dvec2& q) {
  const bool a_is_last = lexicographically_less(b, a) && lexicographically_less(c, a);
  const bool b_is_last = !a_is_last && lexicographically_less(c, b);
  const glm::dvec2& last = a_is_last ? a : b_is_last ? b : c;
  if (lexicographically_less(last, q)) return false;
  return orient2d(a_is_last ? q : a, b_is_last ? q : b, a_is_last || b_is_last ? c : q) > 0;
}

// Whether q lies inside the circle through a, b, c. REQUIRES: a, b, c turn left; q is none of them.
inline bool circle_conflict(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                            const glm::dvec2& q) {
  const int sign = incircle(a, b, c, q);
  return sign != 0 ? sign > 0 : cocircular_inside(a, b, c, q);
}

// Whether q lies strictly between a and b. REQUIRES: the three are collinear.
inline bool strictly_between(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& q) {
  return lexicographically_less(a, b)
             ? lexicographically_less(a, q) && lexicographically_less(q, b)
             : lexicographically_less(b, q) && lexicographically_less(q, a);
}

// Whether q, a point that is no vertex of it, must not be left outside the simplex's circumsphere.
// A ghost conflicts with points strictly beyond its edge of the hull and with points on that edge.
inline bool conflict(const Mesh<2>& mesh, std::span<const glm::dvec2> points, SimplexNumber simplex,
                     const glm::dvec2& q) {
  for (unsigned k = 0; k < 3; ++k) {
    const CornerNumber corner = corner_of(simplex, k);
    if (mesh.vertex(corner) != kInfiniteVertex) continue;
    const glm::dvec2& a = points[mesh.vertex(next_corner(corner))];
    const glm::dvec2& b = points[mesh.vertex(previous_corner(corner))];
    const int side = orient2d(a, b, q);
    return side != 0 ? side > 0 : strictly_between(a, b, q);
  }
  return circle_conflict(points[mesh.vertex(corner_of(simplex, 0))],
                         points[mesh.vertex(corner_of(simplex, 1))],
                         points[mesh.vertex(corner_of(simplex, 2))], q);
}

inline bool lexicographically_less_3d(const glm::dvec3& a, const glm::dvec3& b) {
  return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.z < b.z)));
}

// The 3D predicates for points of which nothing is known.
struct AnyPoints {
  static int orient3d(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                      const glm::dvec3& d) {
    return delaunay::orient3d(a, b, c, d);
  }
  static int insphere(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                      const glm::dvec3& d, const glm::dvec3& q) {
    return delaunay::insphere(a, b, c, d, q);
  }
};

// Whether q counts as inside the sphere through a, b, c, d, on which it lies: the five are visited
// from the lexicographically largest down, because the largest is raised most. On reaching q, it is
// outside; on reaching a vertex whose replacement by q leaves the tetrahedron not flat, the
// orientation of the result decides.
// REQUIRES: a, b, c, d positively oriented; insphere(a, b, c, d, q) == 0; q is none of them.
template <class Predicates>
bool cospherical_inside(const Predicates& predicates, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c, const glm::dvec3& d, const glm::dvec3& q) {
  std::array<const glm::dvec3*, 4> corners = {&a, &b, &c, &d};
  std::array<bool, 4> visited = {};
  while (true) {
    std::size_t last = 4;
    for (std::size_t i = 0; i < 4; ++i) {
      if (visited[i]) continue;
      if (last == 4 || lexicographically_less_3d(*corners[last], *corners[i])) last = i;
    }
    if (last == 4 || lexicographically_less_3d(*corners[last], q)) return false;
    visited[last] = true;
    std::array<const glm::dvec3*, 4> replaced = corners;
    replaced[last] = &q;
    const int sign = predicates.orient3d(*replaced[0], *replaced[1], *replaced[2], *replaced[3]);
    if (sign != 0) return sign > 0;
  }
}

// Whether q lies inside the sphere through a, b, c, d. REQUIRES: a, b, c, d positively oriented; q
// is none of them.
template <class Predicates>
bool sphere_conflict(const Predicates& predicates, const glm::dvec3& a, const glm::dvec3& b,
                     const glm::dvec3& c, const glm::dvec3& d, const glm::dvec3& q) {
  const int sign = predicates.insphere(a, b, c, d, q);
  return sign != 0 ? sign > 0 : cospherical_inside(predicates, a, b, c, d, q);
}

// As in 2D. A ghost conflicts with points strictly beyond its facet of the hull. For a point in the
// facet's plane the rule within that plane gives the same result as the tetrahedron below the
// facet: its sphere meets the plane in the facet's circle, and raising its apex changes nothing.
inline bool conflict(const Mesh<3>& mesh, std::span<const glm::dvec3> points, SimplexNumber simplex,
                     const glm::dvec3& q) {
  constexpr AnyPoints predicates;
  std::array<const glm::dvec3*, 4> p;
  unsigned infinite = 4;
  for (unsigned k = 0; k < 4; ++k) {
    const VertexNumber vertex = mesh.vertex(corner_of(simplex, k));
    p[k] = vertex == kInfiniteVertex ? &q : &points[vertex];
    if (vertex == kInfiniteVertex) infinite = k;
  }
  if (infinite == 4) return sphere_conflict(predicates, *p[0], *p[1], *p[2], *p[3], q);
  const int side = predicates.orient3d(*p[0], *p[1], *p[2], *p[3]);
  if (side != 0) return side > 0;
  return conflict(mesh, points, simplex_of(mesh.neighbour(corner_of(simplex, infinite))), q);
}

}  // namespace delray::delaunay
