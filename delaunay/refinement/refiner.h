// Ruppert's refinement of the part of a mesh that one thread works on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <set>
#include <utility>
#include <vector>

#include "delaunay/mesh/xorshift.h"
#include "delaunay/refine.h"
#include "delaunay/refinement/refinement_cavity.h"
#include "delaunay/refinement/refinement_mesh.h"
#include "delaunay/refinement/small_corners.h"
#include "delaunay/refinement/triangle_shape.h"
#include "delaunay/refinement/urgent_queue.h"

namespace delray::delaunay::internal {

// Cuts pieces of segments that are encroached upon, then triangles that are not as they should be,
// until there is neither (Ruppert 1995):
// - a piece is encroached upon while a vertex beside it lies within its diametral circle;
// - a triangle is cut at its off-centre, unless that encroaches upon pieces, which are cut instead;
// - pieces at a corner of less than 60 degrees are cut as small_corners.h says, and the triangles
//   across such a corner stay as they are (Miller, Pav and Walkington 2003).
//
// `Access` grants triangles and numbers of new ones (mesh/access.h):
//   bool acquire(SimplexNumber)          to read, and to write if the step is finished
//   bool prepare()                       room for a vertex and two triangles; false: stop
//   bool claim()                         whether a step that has acquired all it needs may write
//   VertexNumber vertex()                and two triangle()s, after claim()
//   void release()                       the end of a step
//   bool keeps(SimplexNumber)            whether what was denied there is to be tried again here
template <class Access>
class Refiner {
 public:
  // A piece of a segment.
  struct Piece {
    CornerNumber corner;  // opposite to it
    VertexNumber start, end;
  };

  Refiner(RefinementMesh& mesh, const TriangleBounds& bounds, Access access)
      : mesh_(mesh), cuts_(mesh), bounds_(bounds), access_(std::move(access)) {}

  // The edge opposite to a corner, if it is a piece to be cut.
  void suspect_segment(CornerNumber corner) {
    if (is_encroached(corner)) add_segment(corner);
  }
  // A piece to be cut, unless it is no piece any more.
  void add_piece(const Piece& piece) { segments_.push_back(piece); }
  // A triangle of the domain.
  void suspect_triangle(SimplexNumber t) {
    if (const unsigned urgency = bounds_.urgency(shape(t)); urgency > 0) add_triangle(t, urgency);
  }

  // One step; false if there is nothing left, or no room.
  bool step() {
    if (!access_.prepare()) return false;
    if (!segments_.empty()) {
      const Piece piece = segments_.back();
      segments_.pop_back();
      cut_segment(piece);
    } else if (!triangles_.empty()) {
      cut_triangle(triangles_.pop());
    } else {
      return false;
    }
    access_.release();
    return true;
  }
  bool is_done() const { return segments_.empty() && triangles_.empty(); }
  // What was denied comes again. Returns how much that is. REQUIRES: nobody writes.
  std::size_t retry() {
    const std::size_t count = denied_segments_.size() + denied_.size();
    segments_.insert(segments_.end(), denied_segments_.begin(), denied_segments_.end());
    for (const Triangle& triangle : denied_) {
      if (!is_gone(triangle)) triangles_.push(triangle, bounds_.urgency(shape(triangle.number)));
    }
    denied_segments_.clear();
    denied_.clear();
    denied_pieces_.clear();
    return count;
  }
  // Tries what was denied, and nothing else, with an access that claims nothing.
  void rehearse() {
    const std::vector<Piece> segments = std::exchange(segments_, {});
    UrgentQueue<Triangle> triangles = std::exchange(triangles_, {});
    const std::uint64_t denied = counts_.denied;
    retry();
    while (step()) {
    }
    counts_.denied = denied;
    elsewhere_.clear();
    segments_ = segments;
    triangles_ = std::move(triangles);
  }
  // Pieces that were denied and are not kept here.
  std::vector<Piece> take_elsewhere() { return std::exchange(elsewhere_, {}); }
  // What waits, and what was denied.
  std::size_t pending() const {
    return segments_.size() + triangles_.size() + denied_segments_.size() + denied_.size();
  }
  std::size_t triangles() const { return triangles_.size(); }
  // Gives half of the triangles to another.
  void share(Refiner& other) { triangles_.share(other.triangles_); }

  Access& access() { return access_; }
  const RefineCounts& counts() const { return counts_; }

 private:
  struct Triangle {
    SimplexNumber number;
    std::array<VertexNumber, 3> vertices;
  };

  VertexNumber vertex(CornerNumber corner) const { return mesh_.mesh.vertex(corner); }
  std::array<VertexNumber, 3> vertices_of(SimplexNumber t) const {
    return {mesh_.mesh.vertex(t, 0), mesh_.mesh.vertex(t, 1), mesh_.mesh.vertex(t, 2)};
  }
  TriangleShape shape(SimplexNumber t) const {
    const auto [a, b, c] = vertices_of(t);
    return shape_of_triangle(mesh_.points[a], mesh_.points[b], mesh_.points[c]);
  }
  void add_segment(CornerNumber corner) {
    segments_.push_back({corner, vertex(next_corner(corner)), vertex(previous_corner(corner))});
  }
  void add_triangle(SimplexNumber t, unsigned urgency) {
    triangles_.push({t, vertices_of(t)}, urgency);
  }

  // By the vertex of the corner, or because the piece is no edge of the canonical triangulation. A
  // vertex beside an end of the piece is within its circle by rounding alone.
  bool is_encroached(CornerNumber corner) const {
    const VertexNumber v = vertex(corner);
    if (v == kInfiniteVertex) return false;
    const VertexNumber start = vertex(next_corner(corner)), end = vertex(previous_corner(corner));
    const glm::dvec2& q = mesh_.points[v];
    const SeenAt seen = seen_at(mesh_.points[start], mesh_.points[end], q);
    if (!seen.open && !(seen.obtuse && cuts_.is_beside_end(v, start, end))) return seen.obtuse;
    return conflict(mesh_.mesh, mesh_.places(), simplex_of(mesh_.mesh.neighbour(corner)), q);
  }

  // Inserts into the cavity that was found. REQUIRES: all of it is acquired.
  void insert(const glm::dvec2& q, const SegmentEnds& ends) {
    const VertexNumber v = access_.vertex();
    mesh_.points[v] = q;
    mesh_.ends[v] = ends;
    mesh_.acute[v] = 0;
    const SimplexNumber first = access_.triangle();
    cavity_.fill(mesh_, v, {first, access_.triangle()});
    for (std::size_t i = 0; i < cavity_.border().size(); ++i) {
      const SimplexNumber t = cavity_.star()[i];
      for (unsigned k = 0; k < 3; ++k) {
        if (mesh_.is_segment(corner_of(t, k))) suspect_segment(corner_of(t, k));
      }
      if (mesh_.is_inside(t)) suspect_triangle(t);
    }
  }

  // So many units in the last place away from a line.
  static glm::dvec2 beside(const glm::dvec2& p, const glm::dvec2& along, int units) {
    const double unit = 0x1p-52 * std::max(std::abs(p.x), std::abs(p.y));
    return p + units * unit / glm::length(along) * glm::dvec2(-along.y, along.x);
  }

  bool is_cut(const Piece& piece) const {
    return vertex(next_corner(piece.corner)) != piece.start ||
           vertex(previous_corner(piece.corner)) != piece.end || !mesh_.is_segment(piece.corner);
  }

  void cut_segment(const Piece& piece) {
    if (!access_.acquire(simplex_of(piece.corner))) return deny(piece);
    if (is_cut(piece)) return;
    const glm::dvec2 a = mesh_.points[piece.start], b = mesh_.points[piece.end];
    const glm::dvec2 middle = cuts_.place_on(piece.start, piece.end);
    const bool is_fine = glm::length(b - a) > 4 * mesh_.tolerance;
    // Where rounding leaves no triangle on a side, a few units to that side may do.
    glm::dvec2 q = middle;
    Cavity found = Cavity::flat;
    for (const int units : {0, 1, -1, 3, -3, 9, -9, 27, -27}) {
      if (!is_fine || found != Cavity::flat) break;
      q = units == 0 ? middle : beside(middle, b - a, units);
      found = cavity_.find_on_segment(mesh_, piece.corner, q, access_);
    }
    if (found == Cavity::denied) return deny(piece);
    if (found == Cavity::flat) {
      if (uncut_.insert(ascending(piece.start, piece.end)).second) ++counts_.too_fine;
      return;
    }
    if (!access_.claim()) return deny(piece);
    insert(q, cuts_.segment_of(piece.start, piece.end));
    ++counts_.on_segments;
  }

  // Whether the shortest edge of a triangle goes across a small corner, so that no cut could end
  // what the corner began: between points at equal distances from it on its two sides, or beside
  // the corner itself.
  bool is_excepted(SimplexNumber t, unsigned shortest) const {
    const CornerNumber corner = corner_of(t, shortest);
    const CornerNumber next = next_corner(corner), previous = previous_corner(corner);
    if (mesh_.is_segment(next) && mesh_.is_segment(previous)) return true;
    const SegmentEnds& p = mesh_.ends[vertex(next)];
    const SegmentEnds& q = mesh_.ends[vertex(previous)];
    if (p == kOnNoSegment || q == kOnNoSegment || p == q) return false;
    for (const VertexNumber apex : p) {
      if (apex != q[0] && apex != q[1]) continue;
      const double to_p = glm::length(mesh_.at(next) - mesh_.points[apex]);
      const double to_q = glm::length(mesh_.at(previous) - mesh_.points[apex]);
      constexpr double kEqual = 0x1p-10;  // points on shells are far closer, others seldom so
      if (mesh_.acute[apex] != 0 && std::abs(to_p - to_q) < kEqual * to_p) return true;
    }
    return false;
  }

  bool is_gone(const Triangle& triangle) const {
    return vertices_of(triangle.number) != triangle.vertices;
  }

  // Where a walk from inside of a triangle ends.
  struct Walked {
    enum class End : std::uint8_t { triangle, segment, vertex, denied } end;
    CornerNumber corner;  // of the triangle; opposite to the segment
  };
  Walked walk_to(SimplexNumber from, const glm::dvec2& q) {
    CornerNumber entry = kDeadVertex;
    std::uint32_t random = 2 * from + 1;  // the next time the way is the same
    for (SimplexNumber t = from;;) {
      CornerNumber exit = kDeadVertex;
      // Any first edge: constrained triangulations have ways round for a fixed one.
      CornerNumber corner = corner_of(t, next_random(random) % 3);
      for (int k = 0; k < 3 && exit == kDeadVertex; ++k, corner = next_corner(corner)) {
        if (corner == entry) continue;
        if (orient2d(mesh_.at(next_corner(corner)), mesh_.at(previous_corner(corner)), q) < 0) {
          exit = corner;
        }
      }
      if (exit == kDeadVertex) {
        for (unsigned k = 0; k < 3; ++k) {
          if (mesh_.at(corner_of(t, k)) == q) return {Walked::End::vertex, corner_of(t, k)};
        }
        return {Walked::End::triangle, corner_of(t, 0)};
      }
      if (mesh_.is_segment(exit)) return {Walked::End::segment, exit};
      entry = mesh_.mesh.neighbour(exit);
      t = simplex_of(entry);
      if (!access_.acquire(t)) return {Walked::End::denied, exit};
    }
  }

  void cut_triangle(const Triangle& triangle) {
    const SimplexNumber t = triangle.number;
    if (!access_.acquire(t)) return deny(triangle);
    if (is_gone(triangle)) return;
    const TriangleShape it = shape(t);
    if (!bounds_.is_large(it) && is_excepted(t, it.shortest)) return;
    const CornerNumber corner = corner_of(t, it.shortest);
    const glm::dvec2 &p = mesh_.at(next_corner(corner)), &q = mesh_.at(previous_corner(corner));
    if (glm::length(q - p) <= 8 * mesh_.tolerance) return give_up();
    const glm::dvec2 place = bounds_.place_in(it, p, q, mesh_.at(corner));
    const Walked walked = walk_to(t, place);
    if (walked.end == Walked::End::denied) return deny(triangle);
    if (walked.end == Walked::End::vertex) return give_up();
    if (walked.end == Walked::End::segment) {
      return cut_instead(triangle, std::array{walked.corner});
    }
    if (cavity_.find(mesh_, simplex_of(walked.corner), place, access_) != Cavity::found) {
      return deny(triangle);
    }
    encroached_.clear();
    for (const RefinementCavity::Edge& edge : cavity_.border()) {
      if ((edge.marks & 4U) == 0) continue;
      const CornerNumber within = mesh_.mesh.neighbour(edge.outside);
      if (seen_at(mesh_.points[edge.start], mesh_.points[edge.end], place).obtuse) {
        encroached_.push_back(within);
      }
    }
    if (!encroached_.empty()) return cut_instead(triangle, encroached_);
    if (!access_.claim()) return deny(triangle);
    insert(place, kOnNoSegment);
    ++counts_.inside;
  }

  // Pieces of segments for the triangle, which comes again after them, or as they were denied.
  template <class Corners>
  void cut_instead(const Triangle& triangle, const Corners& corners) {
    for (const CornerNumber corner : corners) {
      const SegmentEnds ends =
          ascending(vertex(next_corner(corner)), vertex(previous_corner(corner)));
      if (uncut_.contains(ends)) return give_up();
    }
    bool is_denied = !access_.claim();
    for (const CornerNumber corner : corners) {
      if (denied_pieces_.contains(
              ascending(vertex(next_corner(corner)), vertex(previous_corner(corner))))) {
        is_denied = true;
      } else {
        add_segment(corner);
      }
    }
    if (is_denied) return deny(triangle);
    triangles_.push(triangle, bounds_.urgency(shape(triangle.number)));
  }
  void give_up() { ++counts_.too_fine; }

  void deny(const Piece& piece) {
    ++counts_.denied;
    denied_pieces_.insert(ascending(piece.start, piece.end));
    (access_.keeps(simplex_of(piece.corner)) ? denied_segments_ : elsewhere_).push_back(piece);
  }
  void deny(const Triangle& triangle) {
    ++counts_.denied;
    if (access_.keeps(triangle.number)) denied_.push_back(triangle);
  }

  RefinementMesh& mesh_;
  SegmentCuts cuts_;
  const TriangleBounds& bounds_;
  Access access_;
  RefinementCavity cavity_;
  std::vector<Piece> segments_;
  UrgentQueue<Triangle> triangles_;
  std::vector<Triangle> denied_;
  std::vector<Piece> denied_segments_, elsewhere_;
  std::set<SegmentEnds> denied_pieces_;
  std::vector<CornerNumber> encroached_;
  // Pieces that doubles are too coarse to cut.
  std::set<SegmentEnds> uncut_;
  RefineCounts counts_;
};

// Shows a refiner the triangles [first, last) and their pieces.
template <class Access>
void suspect_all(const RefinementMesh& mesh, Refiner<Access>& refiner, SimplexNumber first,
                 SimplexNumber last) {
  for (SimplexNumber t = first; t < last; ++t) {
    if (mesh.mesh.is_dead(t)) continue;
    for (unsigned k = 0; k < 3; ++k) {
      if (mesh.is_segment(corner_of(t, k))) refiner.suspect_segment(corner_of(t, k));
    }
    if (mesh.is_inside(t)) refiner.suspect_triangle(t);
  }
}

}  // namespace delray::delaunay::internal
