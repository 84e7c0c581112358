// Inserting a vertex into a mesh with segments: the triangles that it replaces, as far as segments
// do not stand between.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/predicates.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/refinement/refinement_mesh.h"

namespace delray::delaunay::internal {

// How a search for a cavity ended. Nothing is written before fill().
enum class Cavity : std::uint8_t {
  found,
  denied,  // access was refused
  flat,    // a triangle would have no area, as the point is off its segment by rounding
};

// The triangles in conflict with a point (Bowyer 1981, Watson 1981), reached over edges that are
// not marked. A step over an edge is a flip of Lawson's, so the point sees all edges around.
//
// Triangles are acquired before they are read (mesh/access.h). Keeps its memory from one to the
// next. Expected O(1) beside the location.
class RefinementCavity {
 public:
  struct Edge {
    VertexNumber start, end;  // the cavity to its left
    CornerNumber outside;
    std::uint8_t marks;  // kInside of the triangle that goes, and bit 2 for a piece of a segment
  };

  // From a triangle that contains q.
  template <class Access>
  Cavity find(const RefinementMesh& mesh, SimplexNumber start, const glm::dvec2& q,
              Access& access) {
    begin(kOnNoSegment);
    if (!access.acquire(start)) return Cavity::denied;
    removed_.push_back(start);
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber entry = mesh.mesh.neighbour(corner_of(start, (k + 2) % 3));
      if (!dig(mesh, entry, q, access)) return Cavity::denied;
    }
    return Cavity::found;
  }

  // Of a point on the piece of a segment opposite to `corner`, or off it by rounding. Beyond a
  // piece of the hull nothing but its ghost goes: the hull may be concave by rounding until all
  // pieces are cut.
  template <class Access>
  Cavity find_on_segment(const RefinementMesh& mesh, CornerNumber corner, const glm::dvec2& q,
                         Access& access) {
    const CornerNumber beyond = mesh.mesh.neighbour(corner);
    begin({mesh.mesh.vertex(next_corner(corner)), mesh.mesh.vertex(previous_corner(corner))});
    hidden_ = 0;
    for (const CornerNumber side : {corner, beyond}) {
      if (!access.acquire(simplex_of(side))) return Cavity::denied;
      removed_.push_back(simplex_of(side));
      const bool is_ghost = mesh.mesh.vertex(side) == kInfiniteVertex;
      for (const CornerNumber over : {next_corner(side), previous_corner(side)}) {
        const CornerNumber entry = mesh.mesh.neighbour(over);
        if (is_ghost && !access.acquire(simplex_of(entry))) return Cavity::denied;
        if (is_ghost) {
          add_border(mesh, entry, false);
          continue;
        }
        const Cavity found = dig_in_sight(mesh, entry, q, access);
        if (found != Cavity::found) return found;
      }
    }
    // A vertex in the middle of the cavity would be lost.
    return border_.size() == removed_.size() + 2 ? Cavity::found : Cavity::flat;
  }

  // Around the cavity, counterclockwise.
  std::span<const Edge> border() const { return border_; }
  // The new triangles after fill(), one for each edge of the border: start, end, vertex.
  std::span<const SimplexNumber> star() const { return removed_; }

  // Writes the triangles of the vertex, in the place of the removed ones and two more.
  void fill(RefinementMesh& mesh, VertexNumber vertex, const std::array<SimplexNumber, 2>& more) {
    removed_.insert(removed_.end(), more.begin(), more.end());
    const std::size_t n = border_.size();
    const auto is_end = [&](VertexNumber v) {
      return v != kInfiniteVertex && (v == ends_[0] || v == ends_[1]);
    };
    for (std::size_t i = 0; i < n; ++i) {
      const Edge& edge = border_[i];
      const SimplexNumber t = removed_[i];
      mesh.mesh.set_vertex(t, 0, edge.start);
      mesh.mesh.set_vertex(t, 1, edge.end);
      mesh.mesh.set_vertex(t, 2, vertex);
      mesh.mesh.link(corner_of(t, 2), edge.outside);
      mesh.mesh.link(corner_of(t, 1), corner_of(removed_[i == 0 ? n - 1 : i - 1], 0));
      mesh.set_marks(t, static_cast<std::uint8_t>(edge.marks | (is_end(edge.start) ? 2U : 0U) |
                                                  (is_end(edge.end) ? 1U : 0U)));
    }
  }

 private:
  void begin(const SegmentEnds& ends) {
    ends_ = ends;
    removed_.clear();
    border_.clear();
  }

  // Whether q is strictly to the left of the edge opposite to a corner, as seen from beyond.
  static bool sees(const RefinementMesh& mesh, CornerNumber entry, const glm::dvec2& q) {
    const VertexNumber a = mesh.mesh.vertex(previous_corner(entry)),
                       b = mesh.mesh.vertex(next_corner(entry));
    return a == kInfiniteVertex || b == kInfiniteVertex ||
           orient2d(mesh.points[a], mesh.points[b], q) > 0;
  }

  // As dig(), for a point that may be off its segment by rounding and so beyond an edge of a
  // triangle that is flat by rounding: that edge goes, too. Such triangles are outside of the
  // domain, where segments have been cut before.
  template <class Access>
  Cavity dig_in_sight(const RefinementMesh& mesh, CornerNumber entry, const glm::dvec2& q,
                      Access& access) {
    if (!access.acquire(simplex_of(entry))) return Cavity::denied;
    if (sees(mesh, entry, q)) return dig(mesh, entry, q, access) ? Cavity::found : Cavity::denied;
    constexpr int kMostHidden = 16;
    if (mesh.is_segment(entry) || ++hidden_ > kMostHidden) return Cavity::flat;
    removed_.push_back(simplex_of(entry));
    for (const CornerNumber over : {next_corner(entry), previous_corner(entry)}) {
      const Cavity found = dig_in_sight(mesh, mesh.mesh.neighbour(over), q, access);
      if (found != Cavity::found) return found;
    }
    return Cavity::found;
  }

  // The edge opposite to a corner, seen from beyond.
  void add_border(const RefinementMesh& mesh, CornerNumber corner, bool is_segment) {
    const SimplexNumber removed = simplex_of(mesh.mesh.neighbour(corner));
    border_.push_back(
        {mesh.mesh.vertex(previous_corner(corner)), mesh.mesh.vertex(next_corner(corner)), corner,
         static_cast<std::uint8_t>((mesh.marks(removed) & mesh.kInside) | (is_segment ? 4U : 0U))});
  }

  // Comes into the triangle of a corner over the edge opposite to it.
  template <class Access>
  bool dig(const RefinementMesh& mesh, CornerNumber entry, const glm::dvec2& q, Access& access) {
    pending_.assign({entry});
    while (!pending_.empty()) {
      const CornerNumber corner = pending_.back();
      pending_.pop_back();
      const SimplexNumber t = simplex_of(corner);
      if (!access.acquire(t)) return false;
      const CornerNumber next = next_corner(corner), previous = previous_corner(corner);
      const bool is_segment = mesh.is_segment(corner);
      if (is_segment || !conflict(mesh.mesh, mesh.places(), t, q)) {
        add_border(mesh, corner, is_segment);
        continue;
      }
      removed_.push_back(t);
      pending_.push_back(mesh.mesh.neighbour(previous));
      pending_.push_back(mesh.mesh.neighbour(next));
    }
    return true;
  }

  SegmentEnds ends_ = kOnNoSegment;
  int hidden_ = 0;  // triangles that went as the point was beyond their edge
  std::vector<SimplexNumber> removed_;
  std::vector<Edge> border_;  // each starts where the one before it ends
  std::vector<CornerNumber> pending_;
};

// Alone with the mesh.
struct SoleRefinementAccess {
  static bool acquire(SimplexNumber) { return true; }
};

}  // namespace delray::delaunay::internal
