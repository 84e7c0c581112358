// Ranges of one to four points, which divide and conquer triangulates directly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <utility>

#include "delaunay/divide_and_conquer/hull_mesh.h"
#include "delaunay/divide_and_conquer/merge_filter.h"
#include "delaunay/divide_and_conquer/merge_pair.h"
#include "delaunay/flip/four_points.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {

// A triangulated range of points: the extreme vertices of its hull, ties broken by the other
// coordinate.
struct Part {
  HullVertex left, right, bottom, top;
};

inline bool less_by_y(const glm::dvec2& a, const glm::dvec2& b) {
  return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// Lexicographic order. Branchless: the outcome is unpredictable.
inline bool before(double a, double b, double c, double d) {
  return static_cast<bool>(static_cast<int>(a < c) |
                           (static_cast<int>(a == c) & static_cast<int>(b < d)));
}

// Points [first, last) get the triangles [2 first, 2 last - 2) of the mesh, ghosts included.
class BaseCases {
 public:
  // Both must outlive it.
  BaseCases(const HullMesh& hulls, const MergeFilter& filter) : hulls_(hulls), filter_(filter) {}

  // Triangulates points [first, last), one, two or three.
  Part few(std::size_t first, std::size_t last) const {
    const auto vertex = static_cast<VertexNumber>(first);
    if (last - first == 3) return triangle(vertex);
    if (last - first == 2) return segment(vertex);
    const HullVertex only{vertex, kNoGhost};
    return {only, only, only, only};
  }

  // Triangulates four points from `first` on; none if three of them are on a line or all on a
  // circle, or nearly so.
  std::optional<Part> four(VertexNumber first) const {
    const glm::dvec2* p = hulls_.points + first;
    const EdgeViewPair seen_01(p[0], p[1], PointPair(p[2], p[3]));
    const EdgeViewPair seen_23(p[2], p[3], PointPair(p[0], p[1]));
    unsigned left = 0, right = 0, bottom = 0, top = 0;
    for (unsigned i = 1; i < 4; ++i) {
      left = before(p[i].x, p[i].y, p[left].x, p[left].y) ? i : left;
      right = before(p[right].x, p[right].y, p[i].x, p[i].y) ? i : right;
      bottom = before(p[i].y, p[i].x, p[bottom].y, p[bottom].x) ? i : bottom;
      top = before(p[top].y, p[top].x, p[i].y, p[i].x) ? i : top;
    }
    const MergeFilter::Bounds bounds =
        filter_.bounds((p[right].x - p[left].x) + (p[top].y - p[bottom].y));
    const double error = std::max(bounds.cross, 0.0);
    const double determinant =
        seen_01.dot[0] * seen_01.cross[1] - seen_01.cross[0] * seen_01.dot[1];
    const unsigned sure =
        bits_of(absolute(seen_01.cross) > error) & bits_of(absolute(seen_23.cross) > error);
    if (sure != 3 || !(std::abs(determinant) > bounds.circle)) return std::nullopt;
    const unsigned turns = bits_of(seen_01.cross > 0) | bits_of(seen_23.cross > 0) << 2;
    // The determinant is negative inside where the points turn right.
    const bool inside = (determinant > 0) == ((turns & 1) != 0);
    const FourPoints& of = kFourPoints[turns | (inside ? 16 : 0)];
    const std::array<VertexNumber, 5> vertices = {first, first + 1, first + 2, first + 3,
                                                  kInfiniteVertex};
    const SimplexNumber slot = 2 * first;
    for (unsigned i = 0; i < 18; ++i) {
      hulls_.mesh.set_vertex(slot + i / 3, i % 3, vertices[of.vertices[i]]);
      hulls_.mesh.set_neighbour(slot + i / 3, i % 3, corner_of(slot, of.neighbours[i]));
    }
    const auto at = [&](unsigned i) { return HullVertex{first + i, slot + of.ghosts[i]}; };
    return Part{at(left), at(right), at(bottom), at(top)};
  }

 private:
  // Two points are joined by two ghosts, back to back.
  Part segment(VertexNumber first) const {
    const SimplexNumber there = 2 * first, back = there + 1;
    const VertexNumber a = first, b = first + 1;
    hulls_.set_ghost(there, a, b);
    hulls_.set_ghost(back, b, a);
    hulls_.link(there, 2, corner_of(back, 2));
    hulls_.follow(there, back);
    hulls_.follow(back, there);
    const HullVertex at_a{a, there}, at_b{b, back};
    const bool rightward = lexicographically_less(hulls_.points[a], hulls_.points[b]);
    const bool upward = less_by_y(hulls_.points[a], hulls_.points[b]);
    return {rightward ? at_a : at_b, rightward ? at_b : at_a, upward ? at_a : at_b,
            upward ? at_b : at_a};
  }

  Part triangle(VertexNumber first) const {
    const SimplexNumber inside = 2 * first;
    VertexNumber a = first, b = first + 1, c = first + 2;
    const int turn = orient2d(hulls_.points[a], hulls_.points[b], hulls_.points[c]);
    if (turn == 0) return chain(first);
    if (turn < 0) std::swap(b, c);
    hulls_.set_triangle(inside, a, b, c);
    hulls_.set_ghost(inside + 1, a, b);
    hulls_.set_ghost(inside + 2, b, c);
    hulls_.set_ghost(inside + 3, c, a);
    hulls_.link(inside, 2, corner_of(inside + 1, 2));
    hulls_.link(inside, 0, corner_of(inside + 2, 2));
    hulls_.link(inside, 1, corner_of(inside + 3, 2));
    hulls_.follow(inside + 1, inside + 2);
    hulls_.follow(inside + 2, inside + 3);
    hulls_.follow(inside + 3, inside + 1);
    return extremes({{{a, inside + 1}, {b, inside + 2}, {c, inside + 3}}});
  }

  // Three points on a line.
  Part chain(VertexNumber first) const {
    VertexNumber a = first, b = first + 1, c = first + 2;
    if (lexicographically_less(hulls_.points[b], hulls_.points[a])) std::swap(a, b);
    if (lexicographically_less(hulls_.points[c], hulls_.points[b])) std::swap(b, c);
    if (lexicographically_less(hulls_.points[b], hulls_.points[a])) std::swap(a, b);
    const SimplexNumber t = 2 * first;
    hulls_.set_ghost(t, a, b);
    hulls_.set_ghost(t + 1, b, c);
    hulls_.set_ghost(t + 2, c, b);
    hulls_.set_ghost(t + 3, b, a);
    hulls_.link(t, 2, corner_of(t + 3, 2));
    hulls_.link(t + 1, 2, corner_of(t + 2, 2));
    for (SimplexNumber k = 0; k < 4; ++k) hulls_.follow(t + k, t + (k + 1) % 4);
    return extremes({{{a, t}, {a, t}, {c, t + 2}}});
  }

  Part extremes(const std::array<HullVertex, 3>& hull) const {
    Part part{hull[0], hull[0], hull[0], hull[0]};
    for (const HullVertex& v : {hull[1], hull[2]}) {
      const glm::dvec2& p = hulls_.points[v.vertex];
      if (lexicographically_less(p, hulls_.points[part.left.vertex])) part.left = v;
      if (lexicographically_less(hulls_.points[part.right.vertex], p)) part.right = v;
      if (less_by_y(p, hulls_.points[part.bottom.vertex])) part.bottom = v;
      if (less_by_y(hulls_.points[part.top.vertex], p)) part.top = v;
    }
    return part;
  }

  const HullMesh& hulls_;
  const MergeFilter& filter_;
};

}  // namespace delray::delaunay::internal
