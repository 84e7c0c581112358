// Taking a vertex out of a mesh: the hole that its simplices leave, and how it is filled.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// The triangles around a vertex, counterclockwise. The vertex at infinity is neither the first nor
// the last of the ring. Triangle i, with the vertices i and i + 1 of the ring, borders outside on
// corner outside[i].
struct Ring {
  std::vector<VertexNumber> vertices;
  std::vector<CornerNumber> outside;
  std::vector<SimplexNumber> simplices;
};

// REQUIRES: the vertex of `corner` is finite.
inline Ring ring_around(const Mesh<2>& mesh, CornerNumber corner) {
  Ring ring;
  const CornerNumber first = corner;
  do {
    ring.vertices.push_back(mesh.vertex(next_corner(corner)));
    ring.outside.push_back(mesh.neighbour(corner));
    ring.simplices.push_back(simplex_of(corner));
    // Over the edge from the vertex to the last one of this triangle.
    const CornerNumber beyond = mesh.neighbour(next_corner(corner));
    corner = next_corner(beyond);
  } while (corner != first);
  const auto infinite = std::ranges::find(ring.vertices, kInfiniteVertex) - ring.vertices.begin();
  const auto n = static_cast<std::ptrdiff_t>(ring.vertices.size());
  if (infinite < n) {
    const std::ptrdiff_t shift = (infinite + n - 1) % n;  // it comes second
    std::rotate(ring.vertices.begin(), ring.vertices.begin() + shift, ring.vertices.end());
    std::rotate(ring.outside.begin(), ring.outside.begin() + shift, ring.outside.end());
    std::rotate(ring.simplices.begin(), ring.simplices.begin() + shift, ring.simplices.end());
  }
  return ring;
}

// Whether all vertices of a ring with the vertex at infinity are on one line.
inline bool is_flat(const Ring& ring, std::span<const glm::dvec2> points) {
  std::vector<VertexNumber> finite;
  std::ranges::copy_if(ring.vertices, std::back_inserter(finite),
                       [](VertexNumber vertex) { return vertex != kInfiniteVertex; });
  if (finite.size() == ring.vertices.size()) return false;
  for (std::size_t i = 2; i < finite.size(); ++i) {
    if (orient2d(points[finite[0]], points[finite[1]], points[finite[i]]) != 0) return false;
  }
  return true;
}

// The vertex of the ring between i and j that the triangle at the edge from i to j,
// inside the hole, has in the triangulation of the other points.
//
// That is a vertex of the ring, and one whose circle holds none of the others. Circles through both
// ends of the edge are ordered by what they hold, so one pass finds it; beyond the hull half-planes
// are the circles.
inline std::size_t apex(const Ring& ring, std::span<const glm::dvec2> points, std::size_t i,
                        std::size_t j) {
  const VertexNumber a = ring.vertices[i], b = ring.vertices[j];
  // Infinity, the second of the ring, is the apex only if there is no other.
  constexpr std::size_t kSecond = 1;
  const bool has_infinity = i < kSecond && ring.vertices[kSecond] == kInfiniteVertex && kSecond < j;
  std::size_t best = has_infinity ? kSecond : i + 1;
  for (std::size_t m = i + 1; m < j; ++m) {
    const VertexNumber candidate = ring.vertices[m], known = ring.vertices[best];
    if (candidate == kInfiniteVertex) continue;
    const glm::dvec2& q = points[candidate];
    if (a == kInfiniteVertex || b == kInfiniteVertex) {
      if (m == best) continue;
      const glm::dvec2& from = points[a == kInfiniteVertex ? known : a];
      const glm::dvec2& to = points[a == kInfiniteVertex ? b : known];
      const int side = orient2d(from, to, q);
      if (side > 0 || (side == 0 && strictly_between(from, to, q))) best = m;
      continue;
    }
    if (orient2d(points[a], q, points[b]) <= 0) continue;
    const bool is_usable =
        m != best && known != kInfiniteVertex && orient2d(points[a], points[known], points[b]) > 0;
    if (!is_usable || circle_conflict(points[a], points[known], points[b], q)) best = m;
  }
  return best;
}

// Fills the hole within the ring. Takes the slots that it needs from the end of `slots` on.
// O(d^2) for d vertices.
inline void refill(Mesh<2>& mesh, std::span<const glm::dvec2> points, Ring& ring,
                   std::vector<SimplexNumber>& slots) {
  struct Gap {
    std::size_t i, j;     // the ring from i to j is open to
    CornerNumber corner;  // this side of the edge between them
  };
  std::vector<Gap> gaps = {{0, ring.vertices.size() - 1, ring.outside.back()}};
  while (!gaps.empty()) {
    const Gap gap = gaps.back();
    gaps.pop_back();
    if (gap.j == gap.i + 1) {
      mesh.link(gap.corner, ring.outside[gap.i]);
      continue;
    }
    const std::size_t m = apex(ring, points, gap.i, gap.j);
    const SimplexNumber t = slots.back();
    slots.pop_back();
    mesh.set_vertex(corner_of(t, 0), ring.vertices[gap.i]);
    mesh.set_vertex(corner_of(t, 1), ring.vertices[m]);
    mesh.set_vertex(corner_of(t, 2), ring.vertices[gap.j]);
    mesh.link(gap.corner, corner_of(t, 1));
    gaps.push_back({gap.i, m, corner_of(t, 2)});
    gaps.push_back({m, gap.j, corner_of(t, 0)});
  }
}

}  // namespace delray::delaunay::internal
