// What a verifier keeps of the borders of pieces until their other sides come.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "delaunay/verify/findings.h"
#include "delaunay/verify/local_checks.h"
#include "delaunay/verify/place.h"

namespace delray::delaunay::internal {

// A facet with nothing on its other side in its piece, and its simplex: the outward corners of the
// facet (VerifiedMesh::outward()), then the corner opposite to it.
template <int D>
struct BorderFacet {
  using Point = glm::vec<D, double>;
  std::array<Point, D + 1> corners;
  std::array<std::uint64_t, D + 1> rows;
  PieceSimplex of;

  // Corners in an order that is positive.
  std::array<Point, D + 1> simplex() const {
    std::array<Point, D + 1> p = corners;
    // A triangle lies to the left of its edges; a tetrahedron is behind its faces.
    if constexpr (D == 3) std::swap(p[0], p[1]);
    return p;
  }
};

// Facets until they are matched, by the places of their corners: whoever numbers the same place in
// two ways has not made two of it.
template <int D>
class BorderFacets {
 public:
  using Point = typename BorderFacet<D>::Point;
  // Bytes of memory for each, measured.
  static constexpr std::uint64_t kBytes = sizeof(BorderFacet<D>) + 48;

  // The facet on the other side, which is forgotten with this one; none if it has not come. Facets
  // with their simplex on the same side are kept side by side.
  std::optional<BorderFacet<D>> match(const BorderFacet<D>& facet) {
    const auto [key, odd] = key_of(facet);
    const auto [begin, end] = facets_.equal_range(key);
    for (auto at = begin; at != end; ++at) {
      const Kept& kept = at->second;
      if (kept.odd == odd || !same_places(kept.facet, facet)) continue;
      const BorderFacet<D> found = kept.facet;
      facets_.erase(at);
      return found;
    }
    facets_.emplace(key, Kept{facet, odd});
    return std::nullopt;
  }
  std::size_t size() const { return facets_.size(); }
  template <class F>
  void for_each(F&& f) const {
    for (const auto& [key, kept] : facets_) f(kept.facet);
  }

 private:
  struct Kept {
    BorderFacet<D> facet;
    bool odd;
  };
  // A sum, which does not depend on the order; and whether sorting the corners turns the facet
  // round.
  static std::pair<std::uint64_t, bool> key_of(const BorderFacet<D>& facet) {
    std::uint64_t key = 0;
    for (int k = 0; k < D; ++k) key += bits_of_place<D>(facet.corners[k]);
    bool odd = false;
    for (int i = 0; i < D; ++i) {
      for (int j = i + 1; j < D; ++j) odd ^= before(facet.corners[j], facet.corners[i]);
    }
    return {mix_bits(key), odd};
  }
  static bool same_places(const BorderFacet<D>& a, const BorderFacet<D>& b) {
    for (int i = 0; i < D; ++i) {
      bool found = false;
      for (int j = 0; j < D; ++j) found |= a.corners[i] == b.corners[j];
      if (!found) return false;
    }
    return true;
  }

  std::unordered_multimap<std::uint64_t, Kept> facets_;
};

// Vertices on borders, which several pieces have.
template <int D>
class BorderVertices {
 public:
  using Point = glm::vec<D, double>;
  static constexpr std::uint64_t kBytes = sizeof(Point) + 48;

  struct Known {
    bool is_new;          // no piece had this row at this place
    std::uint64_t first;  // the row that came first at the place
  };
  Known add(const Point& place, std::uint64_t row) {
    const auto [at, inserted] = rows_.try_emplace(place, row);
    if (inserted || at->second == row) return {inserted, row};
    return {others_.insert({row, at->second}).second, at->second};
  }
  std::size_t size() const { return rows_.size() + others_.size(); }

 private:
  std::unordered_map<Point, std::uint64_t, PlaceHash<D>> rows_;
  std::set<std::pair<std::uint64_t, std::uint64_t>> others_;  // further rows, with the first
};

}  // namespace delray::delaunay::internal
