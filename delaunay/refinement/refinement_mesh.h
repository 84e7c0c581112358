// The mesh that refinement works on: triangles with marks for segments and for the domain.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>

#include "delaunay/mesh/array.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// The corners that a piece of a segment lies between, the ends of the segment as it was given or
// recovered; infinite for vertices that lie on none.
using SegmentEnds = std::array<VertexNumber, 2>;
constexpr SegmentEnds kOnNoSegment = {kInfiniteVertex, kInfiniteVertex};
inline SegmentEnds ascending(VertexNumber a, VertexNumber b) {
  return {std::min(a, b), std::max(a, b)};
}

// A constrained Delaunay triangulation of the plane: the edges that are pieces of segments are
// marked on both sides, and every other edge is Delaunay among what can be seen from it (Chew
// 1989b). Once no piece is encroached upon, it is the Delaunay triangulation.
class RefinementMesh {
 public:
  static constexpr std::uint8_t kInside = 8;  // above the marks of the three edges

  Mesh<2> mesh;
  Array<glm::dvec2> points;   // per vertex
  Array<SegmentEnds> ends;    // per vertex: of the segment that it was put on
  Array<std::uint8_t> acute;  // per vertex: whether segments meet there at less than 60 degrees
  // Per segment with a small corner, ends ascending: how far from one end pieces are cut by
  // distances from there, the others by those from the other end.
  struct Reach {
    VertexNumber from = kInfiniteVertex;
    double length = 0;
  };
  std::map<SegmentEnds, Reach> reaches;
  SimplexNumber triangles = 0;  // slots in use
  VertexNumber vertices = 0;
  // Coordinates that differ by less are taken for equal by those who cut segments: some units of
  // rounding of the largest.
  double tolerance = 0;

  // Room for so many more vertices, with the two triangles that each adds.
  void reserve(std::size_t more) {
    const auto room = [](std::size_t wanted, std::size_t now) { return std::max(wanted, 2 * now); };
    if (const std::size_t wanted = vertices + more; wanted > points.size()) {
      const std::size_t size = room(wanted, points.size());
      enlarge(points, vertices, size);
      enlarge(ends, vertices, size);
      enlarge(acute, vertices, size);
    }
    if (const std::size_t wanted = triangles + 2 * more; wanted > mesh.size()) {
      mesh.grow(std::min(room(wanted, mesh.size()), std::max(wanted, kMaximumSimplices)));
    }
    if (mesh.size() > marks_.size()) enlarge(marks_, triangles, mesh.size());
  }

  std::span<const glm::dvec2> places() const { return {points.data(), points.size()}; }
  const glm::dvec2& at(CornerNumber corner) const { return points[mesh.vertex(corner)]; }

  std::uint8_t marks(SimplexNumber triangle) const { return marks_[triangle]; }
  void set_marks(SimplexNumber triangle, std::uint8_t marks) { marks_[triangle] = marks; }
  bool is_inside(SimplexNumber triangle) const { return (marks_[triangle] & kInside) != 0; }
  // Whether the edge opposite to a corner is a piece of a segment.
  bool is_segment(CornerNumber corner) const {
    return (marks_[simplex_of(corner)] >> (corner & 3U) & 1U) != 0;
  }
  void mark_segment(CornerNumber corner, bool is_one) {
    for (const CornerNumber side : {corner, mesh.neighbour(corner)}) {
      const auto bit = static_cast<std::uint8_t>(1U << (side & 3U));
      std::uint8_t& marks = marks_[simplex_of(side)];
      marks = static_cast<std::uint8_t>(is_one ? marks | bit : marks & ~bit);
    }
  }

 private:
  template <class T>
  static void enlarge(Array<T>& array, std::size_t used, std::size_t size) {
    Array<T> larger(size);
    std::copy_n(array.data(), std::min(used, array.size()), larger.data());
    array = std::move(larger);
  }

  Array<std::uint8_t> marks_;  // per triangle
};

// Whether q sees a and b at an obtuse angle: no where rounding leaves that open, which says `open`.
//
// A difference is off by u of itself, a product of two by 3 u, the sum by one u more.
struct SeenAt {
  bool obtuse, open;
};
inline SeenAt seen_at(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& q) {
  constexpr double kError = 5 * 0x1p-53;
  const double x = (a.x - q.x) * (b.x - q.x), y = (a.y - q.y) * (b.y - q.y);
  const double error = kError * (std::abs(x) + std::abs(y)) + 0x1p-950;
  return {x + y < -error, std::abs(x + y) <= error};
}

}  // namespace delray::delaunay::internal
