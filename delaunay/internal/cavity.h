// The cavity kernel: inserts a point into a 3D Delaunay triangulation by removing all tetrahedra
// that it is in conflict with and connecting the boundary of the hole to it (Bowyer 1981, Watson
// 1981).
//
// In the mesh that it works on the infinite vertex of a ghost is in corner 3; what it makes keeps
// that, since the new point takes the corner that looks into the cavity.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/conflict.h"
#include "delaunay/internal/curve_order3.h"
#include "delaunay/internal/sphere_tests.h"
#include "delaunay/mesh.h"

namespace delray::delaunay::internal {

// The part of space in which a kernel may work: everywhere.
//
// A kernel writes only simplices whose finite vertices are all in its region, and reads of other
// simplices nothing but their vertices. A neighbour of one of its own shares two finite vertices
// with it, so no other kernel with another region can ever own that one: kernels whose regions are
// disjoint run at the same time without locks.
struct Everywhere {
  static constexpr bool contains(const glm::dvec3&) { return true; }
};

// A slab between two planes.
struct Slab {
  int axis;
  double low, high;
  bool contains(const glm::dvec3& p) const { return p[axis] >= low && p[axis] < high; }
};

enum class Insertion {
  kDone,
  kEqual,      // to another vertex, whose row was lowered if needed
  kElsewhere,  // needs a simplex outside the region; nothing has changed
  kFull,       // no free slots left; nothing has changed
};

template <class Region>
class Cavity {
 public:
  // `vertices` as in CurveOrder3. Slots [first, last) are free.
  Cavity(Mesh<3>& mesh, SpaceVertex* vertices, const SphereTests& tests, const Region& region)
      : mesh_(mesh), vertices_(vertices), tests_(tests), region_(region), table_(kSide * kSide) {
    names_.push_back(kInfiniteVertex);
  }

  void add_slots(SimplexNumber first, SimplexNumber last) {
    next_ = first;
    last_ = last;
  }
  // Free slots: [unused(), last) and those in free_slots().
  SimplexNumber unused() const { return next_; }
  std::vector<SimplexNumber>& free_slots() { return free_; }

  // Where the next search starts. REQUIRES: a finite simplex in the region.
  void start_at(SimplexNumber simplex) { last_simplex_ = simplex; }
  SimplexNumber last_simplex() const { return last_simplex_; }

  // Finds the simplex that the vertex lies in. After kEqual, `place` has that simplex.
  Insertion locate(VertexNumber vertex, SimplexNumber& place);
  // REQUIRES: locate() gave kDone and that place for the vertex.
  Insertion insert(VertexNumber vertex, SimplexNumber place);

 private:
  struct Simplex {
    std::array<VertexNumber, 4> vertices;
    std::array<CornerNumber, 4> neighbours;
    SimplexNumber number;
  };
  // A facet of the cavity's boundary with the new vertex in the corner that looked inwards.
  struct Side {
    std::array<VertexNumber, 4> vertices;
    CornerNumber outer;
    unsigned corner;
    SimplexNumber number;
  };

  const glm::dvec3& at(VertexNumber vertex) const { return vertices_[vertex + 1U].position; }
  std::uint32_t& local(VertexNumber vertex) { return vertices_[vertex + 1U].local; }

  bool owns(SimplexNumber simplex) const {
    for (unsigned k = 0; k < 4; ++k) {
      const VertexNumber vertex = mesh_.vertex(corner_of(simplex, k));
      if (vertex != kInfiniteVertex && !region_.contains(at(vertex))) return false;
    }
    return true;
  }

  bool conflicts(SimplexNumber simplex, const glm::dvec3& q) const {
    const glm::dvec3& a = at(mesh_.vertex(corner_of(simplex, 0)));
    const glm::dvec3& b = at(mesh_.vertex(corner_of(simplex, 1)));
    const glm::dvec3& c = at(mesh_.vertex(corner_of(simplex, 2)));
    const VertexNumber last = mesh_.vertex(corner_of(simplex, 3));
    if (last != kInfiniteVertex) return sphere_conflict(tests_, a, b, c, at(last), q);
    const int side = tests_.orient3d(a, b, c, q);
    return side > 0;
  }

  // A ghost in whose plane q lies conflicts as the finite simplex below it does.
  enum class Answer { kNo, kYes, kForeign };
  Answer ghost_answer(SimplexNumber simplex, const glm::dvec3& q) const;
  Answer answer(SimplexNumber simplex, const glm::dvec3& q) const;

  bool remove(SimplexNumber simplex);
  void restore();
  bool find_slots();
  void connect();
  void connect_by_sorting();
  void name(VertexNumber vertex) {
    std::uint32_t& place = local(vertex);
    if (place < names_.size() && names_[place] == vertex) return;
    place = static_cast<std::uint32_t>(names_.size());
    names_.push_back(vertex);
  }

  static constexpr std::size_t kSide = 64;  // of the table of edges, which fits the first cache

  Mesh<3>& mesh_;
  SpaceVertex* vertices_;
  const SphereTests& tests_;
  Region region_;
  SimplexNumber next_ = 0, last_ = 0, last_simplex_ = 0;
  std::vector<SimplexNumber> free_;
  std::vector<Simplex> cavity_;
  std::vector<Side> sides_;
  std::vector<VertexNumber> names_;  // of the boundary; the infinite vertex has place 0 always
  std::vector<CornerNumber> table_;  // the corner that looks at an edge of two places
};

// The corners (i, j) of the edge that a new simplex has in common with its neighbour opposite to
// corner `looking` if the new vertex is in corner `apex`: (apex, looking, i, j) is an even
// permutation, so the neighbour sees the edge as (j, i).
struct EdgeCorners {
  std::uint8_t i, j;
};
constexpr std::array<std::array<EdgeCorners, 4>, 4> kEdges = {{
    {{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
    {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
    {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
    {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}},
}};

template <class Region>
Insertion Cavity<Region>::locate(VertexNumber vertex, SimplexNumber& place) {
  const glm::dvec3 q = at(vertex);
  SimplexNumber simplex = last_simplex_;
  unsigned entered = 4;
  while (true) {
    std::array<const glm::dvec3*, 4> p;
    std::array<glm::dvec3, 4> r;
    for (unsigned k = 0; k < 4; ++k) {
      p[k] = &at(mesh_.vertex(corner_of(simplex, k)));
      r[k] = *p[k] - q;
    }
    // Whether the point is beyond the facet: with the corner replaced by it the simplex is turned.
    const auto beyond = [&](unsigned k) {
      const auto sign = [&](unsigned i, unsigned j, unsigned l) {
        return tests_.orient_relative(
            r[i], r[j], r[l], [&] { return tests_.orient_exactly(*p[i], *p[j], *p[l], q); });
      };
      switch (k) {
        case 0:
          return sign(1, 2, 3) < 0;
        case 1:
          return sign(0, 3, 2) < 0;
        case 2:
          return sign(0, 1, 3) < 0;
        default:
          return sign(0, 2, 1) < 0;
      }
    };
    unsigned out = 0;
    while (out < 4 && (out == entered || !beyond(out))) ++out;
    if (out == 4) break;
    const CornerNumber next = mesh_.neighbour(corner_of(simplex, out));
    simplex = simplex_of(next);
    entered = next & 3U;
    if (!owns(simplex)) return Insertion::kElsewhere;
    if (mesh_.vertex(corner_of(simplex, 3)) == kInfiniteVertex) break;
  }
  place = simplex;
  for (unsigned k = 0; k < 4; ++k) {
    const VertexNumber other = mesh_.vertex(corner_of(simplex, k));
    if (other == kInfiniteVertex || at(other) != q) continue;
    std::uint32_t& row = vertices_[other + 1U].row;
    row = std::min(row, vertices_[vertex + 1U].row);
    return Insertion::kEqual;
  }
  return Insertion::kDone;
}

template <class Region>
typename Cavity<Region>::Answer Cavity<Region>::ghost_answer(SimplexNumber simplex,
                                                             const glm::dvec3& q) const {
  const int side = tests_.orient3d(at(mesh_.vertex(corner_of(simplex, 0))),
                                   at(mesh_.vertex(corner_of(simplex, 1))),
                                   at(mesh_.vertex(corner_of(simplex, 2))), q);
  if (side != 0) return side > 0 ? Answer::kYes : Answer::kNo;
  // Only the owner may look at what is below.
  if (!owns(simplex)) return Answer::kForeign;
  const SimplexNumber below = simplex_of(mesh_.neighbour(corner_of(simplex, 3)));
  if (mesh_.is_dead(below)) return Answer::kYes;
  return conflicts(below, q) ? Answer::kYes : Answer::kNo;
}

template <class Region>
typename Cavity<Region>::Answer Cavity<Region>::answer(SimplexNumber simplex,
                                                       const glm::dvec3& q) const {
  if (mesh_.vertex(corner_of(simplex, 3)) == kInfiniteVertex) return ghost_answer(simplex, q);
  return conflicts(simplex, q) ? Answer::kYes : Answer::kNo;
}

// Takes a simplex out of the mesh, if it may.
template <class Region>
bool Cavity<Region>::remove(SimplexNumber simplex) {
  if (!owns(simplex)) return false;
  Simplex& removed = cavity_.emplace_back();
  for (unsigned k = 0; k < 4; ++k) {
    removed.vertices[k] = mesh_.vertex(corner_of(simplex, k));
    removed.neighbours[k] = mesh_.neighbour(corner_of(simplex, k));
  }
  removed.number = simplex;
  mesh_.set_vertex(corner_of(simplex, 0), kDeadVertex);
  return true;
}

template <class Region>
void Cavity<Region>::restore() {
  for (const Simplex& removed : cavity_) {
    mesh_.set_vertex(corner_of(removed.number, 0), removed.vertices[0]);
  }
}

// The slots of the removed first, then those that earlier cavities left, then new ones.
template <class Region>
bool Cavity<Region>::find_slots() {
  const std::size_t needed = sides_.size(), own = cavity_.size();
  if (needed > own + free_.size() + (last_ - next_)) return false;
  for (std::size_t i = 0; i < needed; ++i) {
    if (i < own) {
      sides_[i].number = cavity_[i].number;
    } else if (!free_.empty()) {
      sides_[i].number = free_.back();
      free_.pop_back();
    } else {
      sides_[i].number = next_++;
    }
  }
  for (std::size_t i = needed; i < own; ++i) free_.push_back(cavity_[i].number);
  return true;
}

template <class Region>
void Cavity<Region>::connect() {
  for (const Side& side : sides_) {
    std::array<std::size_t, 4> places;
    for (unsigned k = 0; k < 4; ++k) places[k] = k == side.corner ? 0 : local(side.vertices[k]);
    for (unsigned k = 0; k < 4; ++k) {
      if (k == side.corner) continue;
      const EdgeCorners edge = kEdges[side.corner][k];
      table_[places[edge.i] * kSide + places[edge.j]] = corner_of(side.number, k);
    }
  }
  for (const Side& side : sides_) {
    std::array<std::size_t, 4> places;
    for (unsigned k = 0; k < 4; ++k) places[k] = k == side.corner ? 0 : local(side.vertices[k]);
    for (unsigned k = 0; k < 4; ++k) {
      if (k == side.corner) continue;
      const EdgeCorners edge = kEdges[side.corner][k];
      mesh_.set_neighbour(corner_of(side.number, k),
                          table_[places[edge.j] * kSide + places[edge.i]]);
    }
  }
}

template <class Region>
void Cavity<Region>::connect_by_sorting() {
  std::vector<std::pair<std::uint64_t, CornerNumber>> edges;
  edges.reserve(3 * sides_.size());
  for (const Side& side : sides_) {
    for (unsigned k = 0; k < 4; ++k) {
      if (k == side.corner) continue;
      const EdgeCorners edge = kEdges[side.corner][k];
      const auto [low, high] = std::minmax(side.vertices[edge.i], side.vertices[edge.j]);
      edges.emplace_back(std::uint64_t{low} << 32 | high, corner_of(side.number, k));
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    mesh_.link(edges[i].second, edges[i + 1].second);
  }
}

template <class Region>
Insertion Cavity<Region>::insert(VertexNumber vertex, SimplexNumber place) {
  const glm::dvec3 q = at(vertex);
  cavity_.clear();
  sides_.clear();
  names_.resize(1);
  remove(place);
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    for (unsigned k = 0; k < 4; ++k) {
      const CornerNumber outer = cavity_[i].neighbours[k];
      const SimplexNumber other = simplex_of(outer);
      if (mesh_.is_dead(other)) continue;
      const Answer found = answer(other, q);
      if (found == Answer::kForeign || (found == Answer::kYes && !remove(other))) {
        restore();
        return Insertion::kElsewhere;
      }
      if (found == Answer::kYes) continue;
      Side& side = sides_.emplace_back();
      side.vertices = cavity_[i].vertices;
      side.vertices[k] = vertex;
      side.outer = outer;
      side.corner = k;
      for (unsigned j = 0; j < 4; ++j) {
        if (j != k) name(side.vertices[j]);
      }
    }
  }
  if (!find_slots()) {
    restore();
    return Insertion::kFull;
  }
  for (const Side& side : sides_) {
    for (unsigned k = 0; k < 4; ++k) {
      mesh_.set_vertex(corner_of(side.number, k), side.vertices[k]);
    }
    mesh_.link(corner_of(side.number, side.corner), side.outer);
    if (side.vertices[3] != kInfiniteVertex) last_simplex_ = side.number;
  }
  if (names_.size() <= kSide) {
    connect();
  } else {
    connect_by_sorting();
  }
  return Insertion::kDone;
}

}  // namespace delray::delaunay::internal
