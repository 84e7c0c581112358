// The cavity kernel: inserts a point into a 3D Delaunay triangulation by removing all tetrahedra
// that it is in conflict with and connecting the boundary of the hole to it (Bowyer 1981, Watson
// 1981).
//
// In the mesh that it works on the infinite vertex of a ghost is in corner 3.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "delaunay/cavity/four_spheres.h"
#include "delaunay/cavity/regions.h"
#include "delaunay/insertion/facet_walk.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/slot_pool.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/predicates/conflict.h"
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay::internal {

enum class Insertion {
  kDone,
  kEqual,      // to another vertex, whose row was lowered if needed
  kElsewhere,  // needs a simplex outside the region; nothing has changed
  kFull,       // no free slots left; nothing has changed
};

// A kernel writes only simplices whose finite vertices are all in its region, and reads of other
// simplices nothing but their vertices. A neighbour of one of its own shares two finite vertices
// with it, so no other kernel with another region can ever own that one: kernels whose regions are
// disjoint run at the same time without locks. What a kernel notes about a vertex it notes about
// vertices of its own simplices.
template <class Region>
class Cavity {
 public:
  // `vertices` as in CurveOrder3d.
  Cavity(Mesh<3>& mesh, SpaceVertex* vertices, const SphereTests& tests, SlotPool& pool)
      : mesh_(mesh),
        vertices_(vertices),
        tests_(tests),
        pool_(pool),
        test_four_(test_four_spheres()),
        cavity_(64),
        slots_(64),
        boundary_(64),
        sides_(64),
        names_(256, kDeadVertex),
        table_(kPlaces * kPlaces) {}

  void set_region(const Region& region) { region_ = region; }
  const Region& region() const { return region_; }
  // Where the next search starts. REQUIRES: a finite simplex in the region.
  void start_at(SimplexNumber simplex) { last_simplex_ = simplex; }
  SimplexNumber last_simplex() const { return last_simplex_; }

  // From now on the slots of simplices that it makes get `creator` in `created_by`, which has a
  // value for every slot. Null: it notes nothing.
  void note_creator(std::uint16_t* created_by, std::uint16_t creator) {
    created_by_ = created_by;
    creator_ = creator;
  }

  // Finds the simplex that the vertex lies in. After kEqual, `place` has that simplex.
  Insertion locate(VertexNumber vertex, SimplexNumber& place);
  // REQUIRES: locate() gave kDone and that place for the vertex.
  Insertion insert(VertexNumber vertex, SimplexNumber place);

  // Whether the finite vertices of the simplex are all in the region.
  bool owns(SimplexNumber simplex) const {
    if constexpr (!std::is_same_v<Region, Everywhere>) {
      if (region_.is_everywhere()) return true;
      for (unsigned k = 0; k < 4; ++k) {
        const VertexNumber vertex = mesh_.vertex(corner_of(simplex, k));
        if (vertex != kInfiniteVertex && !region_.contains(at(vertex))) return false;
      }
    }
    return true;
  }

  // Marks the slots that it took and never used as dead.
  void retire_unused_slots() {
    for (; next_ < last_; ++next_) mesh_.set_vertex(corner_of(next_, 0), kDeadVertex);
  }

 private:
  struct Simplex {
    std::array<VertexNumber, 4> vertices;
    std::array<CornerNumber, 4> neighbours;
  };
  // A facet of a removed simplex.
  struct Facet {
    std::uint32_t removed;  // its number in the cavity
    unsigned corner;
  };
  // A new simplex: the new vertex in corner 0, a facet of the boundary in the others. The places of
  // its vertices are their numbers among those of the boundary.
  struct Side {
    std::array<VertexNumber, 3> vertices;
    std::array<std::uint32_t, 3> places;
    SimplexNumber number;
  };

  const glm::dvec3& at(VertexNumber vertex) const { return vertices_[vertex + 1U].position; }

  // For what test_four_ left undecided.
  bool conflicts_exactly(SimplexNumber simplex, const glm::dvec3& q) const {
    const auto p = [&](unsigned k) -> const glm::dvec3& {
      return at(mesh_.vertex(corner_of(simplex, k)));
    };
    const int sign = tests_.insphere_exactly(p(0), p(1), p(2), p(3), q);
    return sign != 0 ? sign > 0 : cospherical_inside(tests_, p(0), p(1), p(2), p(3), q);
  }
  bool conflicts(SimplexNumber simplex, const glm::dvec3& q) const {
    return sphere_conflict(
        tests_, at(mesh_.vertex(corner_of(simplex, 0))), at(mesh_.vertex(corner_of(simplex, 1))),
        at(mesh_.vertex(corner_of(simplex, 2))), at(mesh_.vertex(corner_of(simplex, 3))), q);
  }

  // A ghost in whose plane q lies conflicts as the finite simplex below it does.
  enum class Conflict { kNo, kYes, kForeign };
  Conflict ghost_conflict(CornerNumber corner, const glm::dvec3& q) const;

  // Whether the region owns a simplex of which all vertices but the one in this corner are known to
  // be in it.
  bool owns_across(CornerNumber corner) const {
    if constexpr (std::is_same_v<Region, Everywhere>) return true;
    const VertexNumber vertex = mesh_.vertex(corner);
    return vertex == kInfiniteVertex || region_.contains(at(vertex));
  }
  void remove(SimplexNumber simplex);
  void restore();
  // False if a simplex outside the region would have to go.
  bool find_cavity(VertexNumber vertex, SimplexNumber place);
  bool test_facets(const glm::dvec3& q);
  bool find_slots();
  void fill(VertexNumber vertex);
  void connect();
  void connect_by_sorting();
  // Branchless: the outcome is unpredictable. REQUIRES: a finite vertex; room for one more name.
  std::uint32_t place_of(VertexNumber vertex, VertexNumber* names, std::uint32_t& count) {
    std::uint32_t& local = vertices_[vertex + 1U].local;
    const std::uint32_t guess = local < count ? local : 0;
    const std::uint32_t is_new = names[guess] != vertex ? 1 : 0;
    const std::uint32_t place = guess + is_new * (count - guess);
    names[count] = vertex;
    count += is_new;
    local = place;
    return place;
  }

  static constexpr std::size_t kPlaces = 64;  // so that the table fits the first cache

  Mesh<3>& mesh_;
  SpaceVertex* const vertices_;
  const SphereTests& tests_;
  SlotPool& pool_;
  const TestFourSpheres test_four_;
  Region region_;
  SimplexNumber next_ = 0, last_ = 0, last_simplex_ = 0;
  std::uint16_t* created_by_ = nullptr;  // by slot
  std::uint16_t creator_ = 0;
  std::vector<SimplexNumber> free_;
  std::vector<Simplex> cavity_;       // the first cavity_size_
  std::vector<SimplexNumber> slots_;  // of these
  std::size_t cavity_size_ = 0;
  std::vector<Facet> boundary_;  // the first side_count_
  std::vector<Side> sides_;      // the new simplices at them
  std::size_t side_count_ = 0;
  // Facets that wait until it is known whether the simplices beyond them conflict.
  std::array<Facet, 8> facets_;
  std::array<SimplexNumber, 8> beyond_ = {};
  std::size_t facet_count_ = 0;
  // By place, the first name_count_; infinity's place is 0 and its name is not here.
  std::vector<VertexNumber> names_;
  std::uint32_t name_count_ = 1;
  std::vector<std::uint16_t> table_;  // 4 * side + corner that looks at the edge of two places
};

// The corners after a corner that make an even permutation with it.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

template <class Region>
Insertion Cavity<Region>::locate(VertexNumber vertex, SimplexNumber& place) {
  const glm::dvec3 q = at(vertex);
  bool stuck = false;
  const auto exit_of = [&](SimplexNumber here, unsigned entered) -> unsigned {
    // The walk ends at the first ghost.
    if (entered != kNoFacet && mesh_.vertex(corner_of(here, 3)) == kInfiniteVertex) return kNoFacet;
    std::array<const glm::dvec3*, 4> p;
    std::array<glm::dvec3, 4> r;
    for (unsigned k = 0; k < 4; ++k) {
      p[k] = &at(mesh_.vertex(corner_of(here, k)));
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
    bool left_region = false;
    const unsigned exit = exit_facet(0, entered, [&](unsigned k) {
      if (!beyond(k)) return false;
      const bool owned = owns_across(mesh_.neighbour(corner_of(here, k)));
      left_region |= !owned;
      return owned;
    });
    stuck = exit == kNoFacet && left_region;
    return exit;
  };
  const SimplexNumber simplex = walk_over_facets(mesh_, last_simplex_, exit_of);
  if (stuck) return Insertion::kElsewhere;
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

// REQUIRES: the corner looks at a simplex of the region.
template <class Region>
typename Cavity<Region>::Conflict Cavity<Region>::ghost_conflict(CornerNumber corner,
                                                                 const glm::dvec3& q) const {
  const SimplexNumber simplex = simplex_of(corner);
  const int side = tests_.orient3d(at(mesh_.vertex(corner_of(simplex, 0))),
                                   at(mesh_.vertex(corner_of(simplex, 1))),
                                   at(mesh_.vertex(corner_of(simplex, 2))), q);
  if (side != 0) return side > 0 ? Conflict::kYes : Conflict::kNo;
  // Only the owner may look at what is below.
  if (!owns_across(corner)) return Conflict::kForeign;
  const SimplexNumber below = simplex_of(mesh_.neighbour(corner_of(simplex, 3)));
  if (mesh_.is_dead(below)) return Conflict::kYes;
  return conflicts(below, q) ? Conflict::kYes : Conflict::kNo;
}

// Takes a simplex out of the mesh. REQUIRES: room for one more in the cavity.
template <class Region>
void Cavity<Region>::remove(SimplexNumber simplex) {
  slots_[cavity_size_] = simplex;
  Simplex& removed = cavity_[cavity_size_++];
  for (unsigned k = 0; k < 4; ++k) {
    removed.vertices[k] = mesh_.vertex(corner_of(simplex, k));
    removed.neighbours[k] = mesh_.neighbour(corner_of(simplex, k));
    mesh_.prefetch(simplex_of(removed.neighbours[k]));
  }
  mesh_.set_vertex(corner_of(simplex, 0), kDeadVertex);
}

template <class Region>
void Cavity<Region>::restore() {
  for (std::size_t i = 0; i < cavity_size_; ++i) {
    mesh_.set_vertex(corner_of(slots_[i], 0), cavity_[i].vertices[0]);
  }
}

// Decides up to four of the waiting facets. REQUIRES: at least one, beyond each a live simplex.
template <class Region>
bool Cavity<Region>::test_facets(const glm::dvec3& q) {
  const std::size_t count = std::min<std::size_t>(facet_count_, 4);
  for (std::size_t i = count; i < 4; ++i) beyond_[i] = beyond_[0];
  FourConflicts found = test_four_(tests_, vertices_, mesh_, beyond_.data(), q);
  for (; found.undecided != 0; found.undecided &= found.undecided - 1) {
    const int i = std::countr_zero(found.undecided);
    const bool inside = conflicts_exactly(beyond_[static_cast<std::size_t>(i)], q);
    found.inside = (found.inside & ~(1U << i)) | (inside ? 1U : 0U) << i;
  }
  // The sides are finished when all are known, so that half of the branches here are none.
  std::array<CornerNumber, 4> inside;
  std::size_t inside_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_inside = (found.inside >> i & 1U) != 0;
    boundary_[side_count_] = facets_[i];
    side_count_ += is_inside ? 0 : 1;
    inside[inside_count] = cavity_[facets_[i].removed].neighbours[facets_[i].corner];
    inside_count += is_inside ? 1 : 0;
  }
  for (std::size_t i = 0; i < inside_count; ++i) {
    if (mesh_.is_dead(simplex_of(inside[i]))) continue;  // two facets of the four lead there
    if (!owns_across(inside[i])) return false;
    remove(simplex_of(inside[i]));
  }
  std::size_t left = 0;
  for (std::size_t i = count; i < facet_count_; ++i) {
    facets_[left] = facets_[i];
    beyond_[left] = beyond_[i];
    left += mesh_.is_dead(beyond_[i]) ? 0 : 1;  // since just now
  }
  facet_count_ = left;
  return true;
}

template <class Region>
bool Cavity<Region>::find_cavity(VertexNumber vertex, SimplexNumber place) {
  // A step removes or adds at most eight.
  constexpr std::size_t kRoom = 8;
  const glm::dvec3 q = at(vertex);
  cavity_size_ = 0;
  side_count_ = 0;
  facet_count_ = 0;
  remove(place);
  std::size_t next = 0;
  while (true) {
    if (cavity_size_ + kRoom > cavity_.size()) {
      cavity_.resize(2 * cavity_.size());
      slots_.resize(cavity_.size());
    }
    if (side_count_ + kRoom > boundary_.size()) boundary_.resize(2 * boundary_.size());
    if (facet_count_ >= 4 || next == cavity_size_) {
      if (facet_count_ == 0) return true;
      if (!test_facets(q)) return false;
      continue;
    }
    for (unsigned k = 0; k < 4; ++k) {
      const Facet facet{static_cast<std::uint32_t>(next), k};
      const CornerNumber corner = cavity_[next].neighbours[k];
      const SimplexNumber other = simplex_of(corner);
      const bool dead = mesh_.is_dead(other);
      if (mesh_.vertex(corner_of(other, 3)) != kInfiniteVertex) {
        facets_[facet_count_] = facet;
        beyond_[facet_count_] = other;
        facet_count_ += dead ? 0 : 1;
        continue;
      }
      if (dead) continue;
      const Conflict found = ghost_conflict(corner, q);
      if (found == Conflict::kNo) {
        boundary_[side_count_++] = facet;
        continue;
      }
      if (found == Conflict::kForeign || !owns_across(corner)) return false;
      remove(other);
    }
    ++next;
  }
}

// The slots of the removed first, then those that earlier cavities left, then new ones.
template <class Region>
bool Cavity<Region>::find_slots() {
  const std::size_t needed = side_count_, own = cavity_size_;
  while (needed > own + free_.size() + (last_ - next_)) {
    for (; next_ < last_; ++next_) {
      mesh_.set_vertex(corner_of(next_, 0), kDeadVertex);
      free_.push_back(next_);
    }
    std::tie(next_, last_) = pool_.take();
    if (next_ == last_) return false;
  }
  if (sides_.size() < needed) sides_.resize(2 * needed);
  if (names_.size() < 3 * needed + 2) names_.resize(6 * needed);
  for (std::size_t i = 0; i < needed; ++i) {
    if (i < own) {
      sides_[i].number = slots_[i];
    } else if (!free_.empty()) {
      sides_[i].number = free_.back();
      free_.pop_back();
    } else {
      sides_[i].number = next_++;
    }
  }
  for (std::size_t i = needed; i < own; ++i) free_.push_back(slots_[i]);
  return true;
}

// Makes the new simplices, which know nothing of each other yet.
template <class Region>
void Cavity<Region>::fill(VertexNumber vertex) {
  VertexNumber* const names = names_.data();
  std::uint32_t count = 1;
  for (std::size_t i = 0; i < side_count_; ++i) {
    const Facet facet = boundary_[i];
    const Simplex& removed = cavity_[facet.removed];
    const auto& others = kOthers[facet.corner];
    Side& side = sides_[i];
    std::array<VertexNumber, 3> v = {removed.vertices[others[0]], removed.vertices[others[1]],
                                     removed.vertices[others[2]]};
    if (v[0] == kInfiniteVertex) {
      v = {v[1], v[2], v[0]};
    } else if (v[1] == kInfiniteVertex) {
      v = {v[2], v[0], v[1]};
    }
    side.vertices = v;
    side.places[0] = place_of(v[0], names, count);
    side.places[1] = place_of(v[1], names, count);
    side.places[2] = v[2] == kInfiniteVertex ? 0 : place_of(v[2], names, count);
    mesh_.set_vertex(corner_of(side.number, 0), vertex);
    for (unsigned k = 0; k < 3; ++k) mesh_.set_vertex(corner_of(side.number, k + 1), v[k]);
    mesh_.link(corner_of(side.number, 0), removed.neighbours[facet.corner]);
    if (v[2] != kInfiniteVertex) last_simplex_ = side.number;
  }
  name_count_ = count;
}

// The neighbour across the facet with an edge of the boundary sees that edge in reverse.
template <class Region>
void Cavity<Region>::connect() {
  for (std::size_t i = 0; i < side_count_; ++i) {
    const auto [a, b, c] = sides_[i].places;
    const auto number = static_cast<std::uint16_t>(4 * i);
    table_[b * kPlaces + c] = number + 1;
    table_[c * kPlaces + a] = number + 2;
    table_[a * kPlaces + b] = number + 3;
  }
  for (std::size_t i = 0; i < side_count_; ++i) {
    const auto [a, b, c] = sides_[i].places;
    const auto set = [&](unsigned k, std::uint32_t other) {
      mesh_.set_neighbour(corner_of(sides_[i].number, k),
                          corner_of(sides_[other / 4].number, other % 4));
    };
    set(1, table_[c * kPlaces + b]);
    set(2, table_[a * kPlaces + c]);
    set(3, table_[b * kPlaces + a]);
  }
}

template <class Region>
void Cavity<Region>::connect_by_sorting() {
  std::vector<std::pair<std::uint64_t, CornerNumber>> edges;
  edges.reserve(3 * side_count_);
  for (std::size_t i = 0; i < side_count_; ++i) {
    const Side& side = sides_[i];
    for (unsigned k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(side.vertices[(k + 1) % 3], side.vertices[(k + 2) % 3]);
      edges.emplace_back(std::uint64_t{low} << 32 | high, corner_of(side.number, k + 1));
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    mesh_.link(edges[i].second, edges[i + 1].second);
  }
}

template <class Region>
Insertion Cavity<Region>::insert(VertexNumber vertex, SimplexNumber place) {
  if (!find_cavity(vertex, place)) {
    restore();
    return Insertion::kElsewhere;
  }
  if (!find_slots()) {
    restore();
    return Insertion::kFull;
  }
  fill(vertex);
  if (name_count_ <= kPlaces) {
    connect();
  } else {
    connect_by_sorting();
  }
  if (created_by_ != nullptr) {
    for (std::size_t i = 0; i < side_count_; ++i) created_by_[sides_[i].number] = creator_;
  }
  return Insertion::kDone;
}

}  // namespace delray::delaunay::internal
