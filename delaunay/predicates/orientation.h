// Orientation where one of the points may be the infinite vertex.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "delaunay/mesh/mesh.h"
#include "delaunay/predicates.h"

namespace delray::delaunay {

template <int D>
class Orientation;  // in space: orientation_3d.h

// The infinite vertex behaves as if it lay opposite to a point o just inside the first triangle: a
// hull vertex a and the infinite vertex span the ray from a away from o. Those rays cut what is
// outside the hull into one region per ghost, whatever the hull is later on, so that ghosts contain
// points, are subdivided and flipped by the code that serves triangles.
//
// o is the triangle's first vertex moved a little towards its second and less towards its third:
// the first of them that is not collinear decides.
template <>
class Orientation<2> {
 public:
  // REQUIRES: `points` outlives it; `first` are vertices of a triangle that turns left.
  Orientation(std::span<const glm::dvec2> points, const std::array<VertexNumber, 3>& first)
      : points_(points.data()), inner_{points[first[0]], points[first[1]], points[first[2]]} {}

  // +1 if a, b, q turn left, -1 if right, 0 if collinear or q equals the finite one of them.
  // REQUIRES: at most one of a and b is infinite.
  int operator()(VertexNumber a, VertexNumber b, const glm::dvec2& q) const {
    if (a == kInfiniteVertex) return about(b, q);
    if (b == kInfiniteVertex) return -about(a, q);
    return orient2d(points_[a], points_[b], q);
  }
  // The orientation of three vertices, of which at most one is infinite.
  int of_vertices(VertexNumber a, VertexNumber b, VertexNumber c) const {
    return c == kInfiniteVertex ? about(a, points_[b]) : (*this)(a, b, points_[c]);
  }

 private:
  // The side of q as seen from a towards o.
  int about(VertexNumber a, const glm::dvec2& q) const {
    for (const glm::dvec2& inner : inner_) {
      // Mostly that of a hull that still is the first triangle: no need to ask for what is known.
      if (points_[a] == inner) continue;
      if (const int side = orient2d(points_[a], inner, q); side != 0) return side;
    }
    return 0;
  }

  const glm::dvec2* points_;
  std::array<glm::dvec2, 3> inner_;
};

}  // namespace delray::delaunay
