// A stack of pieces: one that is an edge is marked, another is cut and its halves come back. From
// one of its ends a look along the piece finds the first vertex on it or marked edge across it.
// Expected O(1) for a piece beside the location of its middle, which walks from an end.
//
// Degenerate: pieces of a few units of rounding are given up and counted.
#include "delaunay/refinement/recover_segments.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "delaunay/insertion/walk.h"
#include "delaunay/predicates.h"
#include "delaunay/refinement/refinement_cavity.h"

namespace delray::delaunay::internal {
namespace {

constexpr CornerNumber kNoCorner = 0xffffffffU;

class SegmentRecovery {
 public:
  SegmentRecovery(RefinementMesh& mesh, const RefinementLimits& limits, RefineCounts& counts)
      : mesh_(mesh),
        limits_(limits),
        counts_(counts),
        first_added_(mesh.vertices),
        near_(mesh.vertices) {
    for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
      if (mesh.mesh.is_dead(t)) continue;
      for (unsigned k = 0; k < 3; ++k) note(mesh.mesh.vertex(t, k), t);
    }
  }

  void recover(const SegmentEnds& segment) {
    pieces_.assign({segment});
    while (!pieces_.empty()) {
      const auto [a, b] = pieces_.back();
      pieces_.pop_back();
      if (a != b) recover_piece(a, b);
    }
  }

  // Vertices that were added where nothing but one segment is are on it, from where it meets
  // anything to where it does so again.
  void join_pieces() {
    const VertexNumber first = first_added_;
    struct Links {
      std::array<VertexNumber, 2> to = kOnNoSegment;
      int count = 0;
    };
    std::vector<Links> links(mesh_.vertices - first);
    for (SimplexNumber t = 0; t < mesh_.triangles; ++t) {
      for (unsigned k = 0; k < 3 && !mesh_.mesh.is_dead(t); ++k) {
        const CornerNumber corner = corner_of(t, k);
        if (!mesh_.is_segment(corner)) continue;
        // The triangle beyond has the edge the other way round.
        const VertexNumber from = vertex(next_corner(corner));
        if (from < first) continue;
        Links& of = links[from - first];
        if (of.count < 2)
          of.to[static_cast<std::size_t>(of.count)] = vertex(previous_corner(corner));
        ++of.count;
      }
    }
    const auto is_between = [&](VertexNumber v) {
      return v >= first && links[v - first].count == 2;
    };
    std::vector<VertexNumber> joined;
    for (VertexNumber v = first; v < mesh_.vertices; ++v) {
      if (!is_between(v) || mesh_.ends[v] != kOnNoSegment) continue;
      joined.assign({v});
      SegmentEnds ends;
      for (std::size_t side = 0; side < 2; ++side) {
        VertexNumber before = v, at = links[v - first].to[side];
        while (at != v && is_between(at)) {
          joined.push_back(at);
          const std::array<VertexNumber, 2>& to = links[at - first].to;
          before = std::exchange(at, to[0] == before ? to[1] : to[0]);
        }
        ends[side] = at;
      }
      // Rounding may fold pieces upon each other.
      if (ends[0] == ends[1]) continue;
      for (const VertexNumber of : joined) mesh_.ends[of] = ends;
    }
  }

 private:
  VertexNumber vertex(CornerNumber corner) const { return mesh_.mesh.vertex(corner); }
  void note(VertexNumber vertex, SimplexNumber t) {
    if (vertex != kInfiniteVertex) near_[vertex] = t;
  }
  void add(VertexNumber a, VertexNumber v, VertexNumber b) {
    pieces_.push_back({v, b});
    pieces_.push_back({a, v});
  }

  CornerNumber corner_at(VertexNumber v) const {
    CornerNumber corner = corner_of(near_[v], 0);
    while (vertex(corner) != v) corner = next_corner(corner);
    return corner;
  }
  // The corner of the same vertex in the next triangle counterclockwise.
  CornerNumber turn(CornerNumber corner) const {
    return next_corner(mesh_.mesh.neighbour(next_corner(corner)));
  }

  // Whether v is on the piece from a to b, between its ends, so that both parts are shorter:
  // otherwise three vertices within the tolerance would cut each other's pieces for ever.
  bool is_on(VertexNumber a, VertexNumber b, VertexNumber v) const {
    if (v == kInfiniteVertex || v == a || v == b) return false;
    const glm::dvec2 along = mesh_.points[b] - mesh_.points[a];
    const glm::dvec2 to_v = mesh_.points[v] - mesh_.points[a];
    const glm::dvec2 from_v = mesh_.points[b] - mesh_.points[v];
    if (std::max(glm::dot(to_v, to_v), glm::dot(from_v, from_v)) >= glm::dot(along, along)) {
      return false;
    }
    const double length = glm::length(along), place = glm::dot(along, to_v) / length;
    if (place <= 0 || place >= length) return false;
    const double off = std::abs(along.x * to_v.y - along.y * to_v.x) / length;
    return off <= mesh_.tolerance ||
           orient2d(mesh_.points[a], mesh_.points[b], mesh_.points[v]) == 0;
  }

  // The corner opposite to the edge between two vertices, if there is one, and that of the two that
  // has fewer neighbours: one of them may have very many.
  struct Between {
    CornerNumber edge = kNoCorner;
    bool fewer_at_second = false;
  };
  Between edge_between(VertexNumber a, VertexNumber b) const {
    const CornerNumber first_at_a = corner_at(a), first_at_b = corner_at(b);
    CornerNumber at_a = first_at_a, at_b = first_at_b;
    for (;;) {
      if (vertex(next_corner(at_a)) == b) return {previous_corner(at_a), false};
      if (vertex(next_corner(at_b)) == a) return {previous_corner(at_b), false};
      at_a = turn(at_a);
      if (at_a == first_at_a) return {kNoCorner, false};
      at_b = turn(at_b);
      if (at_b == first_at_b) return {kNoCorner, true};
    }
  }

  // The first thing along a piece that is no edge.
  struct Obstacle {
    VertexNumber vertex = kInfiniteVertex;  // on it
    CornerNumber across = kNoCorner;        // opposite to a marked edge
  };
  // Looks a little way only: what is farther comes up with a shorter piece.
  Obstacle look_along(VertexNumber a, VertexNumber b) const {
    constexpr int kSteps = 64;
    CornerNumber corner = first_crossed(a, b);
    for (int step = 0; step < kSteps && corner != kNoCorner; ++step) {
      for (const CornerNumber side : {next_corner(corner), previous_corner(corner)}) {
        if (is_on(a, b, vertex(side))) return {vertex(side)};
      }
      if (mesh_.is_segment(corner)) return {kInfiniteVertex, corner};
      const CornerNumber beyond = mesh_.mesh.neighbour(corner);
      const VertexNumber v = vertex(beyond);
      if (v == b || v == kInfiniteVertex) break;
      const int side = orient2d(mesh_.points[a], mesh_.points[b], mesh_.points[v]);
      if (side == 0) return is_on(a, b, v) ? Obstacle{v} : Obstacle{};
      corner = side > 0 ? next_corner(beyond) : previous_corner(beyond);
    }
    return {};
  }
  // The corner of a in the triangle where the way to b begins; of a neighbour on it either of two.
  CornerNumber first_crossed(VertexNumber a, VertexNumber b) const {
    const CornerNumber first = corner_at(a);
    CornerNumber corner = first;
    const glm::dvec2 &from = mesh_.points[a], &to = mesh_.points[b];
    do {
      const VertexNumber u = vertex(next_corner(corner)), w = vertex(previous_corner(corner));
      if (u != kInfiniteVertex && w != kInfiniteVertex &&
          orient2d(from, mesh_.points[u], to) >= 0 && orient2d(from, mesh_.points[w], to) <= 0) {
        return corner;
      }
      corner = turn(corner);
    } while (corner != first);
    return kNoCorner;
  }

  void recover_piece(VertexNumber a, VertexNumber b) {
    const auto [edge, fewer_at_second] = edge_between(a, b);
    if (edge != kNoCorner) {
      for (const CornerNumber side : {edge, mesh_.mesh.neighbour(edge)}) {
        if (is_on(a, b, vertex(side))) return add(a, vertex(side), b);
      }
      mesh_.mark_segment(edge, true);
      return;
    }
    const Obstacle obstacle = fewer_at_second ? look_along(b, a) : look_along(a, b);
    if (obstacle.vertex != kInfiniteVertex) return add(a, obstacle.vertex, b);
    if (obstacle.across != kNoCorner) return cross(a, b, obstacle.across);
    cut_in_the_middle(a, b);
  }

  void cut_in_the_middle(VertexNumber a, VertexNumber b) {
    const glm::dvec2 q = 0.5 * mesh_.points[a] + 0.5 * mesh_.points[b];
    if (glm::length(mesh_.points[b] - mesh_.points[a]) <= 4 * mesh_.tolerance) return give_up();
    const Place place = walk(mesh_.mesh, mesh_.places(), near_[a], q, random_);
    if (place.equal != kInfiniteVertex) return add(a, place.equal, b);
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(place.simplex, k);
      if (!mesh_.is_segment(corner)) continue;
      if (orient2d(mesh_.at(next_corner(corner)), mesh_.at(previous_corner(corner)), q) != 0) {
        continue;
      }
      if (cavity_.find_on_segment(mesh_, corner, q, access_) != Cavity::found) return give_up();
      ++counts_.crossings;
      return add(a, insert(q), b);
    }
    cavity_.find(mesh_, place.simplex, q, access_);
    ++counts_.on_segments;
    add(a, insert(q), b);
  }

  // Of the piece from a to b and the marked edge opposite to a corner.
  void cross(VertexNumber a, VertexNumber b, CornerNumber corner) {
    const VertexNumber u = vertex(next_corner(corner)), w = vertex(previous_corner(corner));
    for (const VertexNumber end : {a, b}) {
      if (!is_on(u, w, end)) continue;
      mesh_.mark_segment(corner, false);
      pieces_.push_back({a, b});
      return add(u, end, w);
    }
    const glm::dvec2 along = mesh_.points[b] - mesh_.points[a];
    const auto off = [&](VertexNumber v) {
      const glm::dvec2 to_v = mesh_.points[v] - mesh_.points[a];
      return along.x * to_v.y - along.y * to_v.x;
    };
    const double of_u = off(u), of_w = off(w);
    const glm::dvec2 q =
        mesh_.points[u] + of_u / (of_u - of_w) * (mesh_.points[w] - mesh_.points[u]);
    if (q == mesh_.points[u] || q == mesh_.points[w] || !std::isfinite(q.x + q.y) ||
        cavity_.find_on_segment(mesh_, corner, q, access_) != Cavity::found) {
      return give_up();
    }
    ++counts_.crossings;
    add(a, insert(q), b);
  }

  void give_up() { ++counts_.too_fine; }

  // Into the cavity that was found.
  VertexNumber insert(const glm::dvec2& q) {
    if (mesh_.vertices >= limits_.most_vertices) {
      throw std::length_error("segments take more than " + std::to_string(limits_.most_vertices) +
                              " points");
    }
    if (limits_.progress != nullptr) limits_.progress->advance();
    mesh_.reserve(1);
    const VertexNumber v = mesh_.vertices++;
    mesh_.points[v] = q;
    mesh_.ends[v] = kOnNoSegment;
    mesh_.acute[v] = 0;
    const SimplexNumber first = mesh_.triangles;
    mesh_.triangles += 2;
    cavity_.fill(mesh_, v, {first, first + 1});
    near_.push_back(0);
    for (std::size_t i = 0; i < cavity_.border().size(); ++i) {
      const SimplexNumber t = cavity_.star()[i];
      for (unsigned k = 0; k < 3; ++k) note(mesh_.mesh.vertex(t, k), t);
    }
    return v;
  }

  RefinementMesh& mesh_;
  const RefinementLimits& limits_;
  RefineCounts& counts_;
  SoleRefinementAccess access_;
  RefinementCavity cavity_;
  VertexNumber first_added_;
  std::vector<SimplexNumber> near_;  // per vertex: a triangle that it is a corner of
  std::vector<SegmentEnds> pieces_;
  std::uint32_t random_ = 1;
};

}  // namespace

void recover_segments(RefinementMesh& mesh, std::span<const SegmentEnds> segments,
                      const RefinementLimits& limits, RefineCounts& counts) {
  SegmentRecovery recovery(mesh, limits, counts);
  for (const SegmentEnds& segment : segments) recovery.recover(segment);
  recovery.join_pieces();
}

}  // namespace delray::delaunay::internal
