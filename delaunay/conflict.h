// When a point destroys a simplex, and how simplices with the infinite vertex are oriented. Nothing
// else knows about ghosts and about points on a common circle.
//
// Ties are broken by lifting: every point is raised onto the paraboloid and then by an
// infinitesimal amount that falls with its place in lexicographic order (Devillers and Teillaud
// 2011). So the triangulation is unique: it does not depend on the order in which points arrive.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh.h"
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

}  // namespace delray::delaunay
