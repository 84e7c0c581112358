// Quickhull, whatever the space (Barber, Dobkin and Huhdanpaa 1996).
//
// Facets of a convex hull keep the points that lie outside of them; the farthest of one facet's is
// added next, and the points of the facets that it sees go to the new ones. A space says exactly
// whether a point is outside of a facet, also where the two are in one hyperplane, so that the
// facets that a point sees always are a disk. Expected O(n log n) where points are spread evenly in
// two or three dimensions.
//
// A space is a class with
//   kCorners                        of a facet
//   orient(corners, inner)          turns a facet so that a point, of the first ones, is inside
//   is_outside(hull, facet, v)      exact
//   height(corners, v)              above the facet, but for rounding: decides about time alone
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "delaunay/construction/corners_hash.h"
#include "delaunay/mesh/mesh.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {

template <class Space>
class QuickHull {
 public:
  static constexpr unsigned kCorners = Space::kCorners;
  using Corners = std::array<VertexNumber, kCorners>;
  using FacetNumber = std::uint32_t;

  // Of the vertices `first`, which span the space, and `others` to be added. REQUIRES: others are
  // distinct; the space outlives it.
  QuickHull(const Space& space, const std::array<VertexNumber, kCorners + 1>& first,
            const std::vector<VertexNumber>& others, parallel::Progress* progress)
      : space_(space), progress_(progress) {
    std::vector<FacetNumber> all;
    for (unsigned f = 0; f <= kCorners; ++f) {
      all.push_back(create());
      Corners& corners = corners_[f];
      std::copy_if(first.begin(), first.end(), corners.begin(),
                   [&](VertexNumber v) { return v != first[f]; });
      space_.orient(corners, first[f]);
    }
    for (unsigned f = 0; f <= kCorners; ++f) {
      for (unsigned g = 0; g < f; ++g) link(f, corner(f, first[g]), g, corner(g, first[f]));
    }
    distribute(others, all);
    to_visit_ = std::move(all);
  }

  void run() {
    while (!to_visit_.empty()) {
      const FacetNumber facet = to_visit_.back();
      if (is_dead(facet) || outside_[facet].empty()) {
        to_visit_.pop_back();
        continue;
      }
      add(take_farthest(facet), facet);
      if (progress_ != nullptr) progress_->advance();
    }
  }

  // Of all facets, dead ones included.
  std::size_t size() const { return corners_.size(); }
  bool is_dead(FacetNumber facet) const { return corners_[facet][0] == kDeadVertex; }
  const Corners& corners(FacetNumber facet) const { return corners_[facet]; }
  // The facet across the ridge opposite to corner k.
  FacetNumber across(FacetNumber facet, unsigned k) const { return across_[facet][k] / 8; }

 private:
  struct Ridge {
    FacetNumber facet;
    unsigned corner;
  };
  using RidgeKey = std::array<VertexNumber, kCorners - 2>;  // but for the vertex that is added

  unsigned corner(FacetNumber facet, VertexNumber vertex) const {
    return static_cast<unsigned>(std::ranges::find(corners_[facet], vertex) -
                                 corners_[facet].begin());
  }
  void link(FacetNumber a, unsigned i, FacetNumber b, unsigned j) {
    across_[a][i] = 8 * b + j;
    across_[b][j] = 8 * a + i;
  }

  // Each to the first facet of which it is outside; those that are inside are dropped.
  void distribute(const std::vector<VertexNumber>& vertices,
                  const std::vector<FacetNumber>& facets) {
    for (const VertexNumber v : vertices) {
      const auto facet = std::ranges::find_if(
          facets, [&](FacetNumber t) { return space_.is_outside(*this, t, v); });
      if (facet != facets.end()) {
        outside_[*facet].push_back(v);
      } else if (progress_ != nullptr) {
        progress_->advance();
      }
    }
  }

  VertexNumber take_farthest(FacetNumber facet) {
    std::vector<VertexNumber>& candidates = outside_[facet];
    std::size_t farthest = 0;
    double most = -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double h = space_.height(corners_[facet], candidates[i]);
      if (h > most) {
        most = h;
        farthest = i;
      }
    }
    std::swap(candidates[farthest], candidates.back());
    const VertexNumber result = candidates.back();
    candidates.pop_back();
    return result;
  }

  // Replaces the facets that v sees, of which `seen` is one.
  void add(VertexNumber v, FacetNumber seen) {
    std::vector<FacetNumber> visible = {seen};
    std::vector<Ridge> horizon;
    is_visible_.clear();
    is_visible_[seen] = true;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      for (unsigned k = 0; k < kCorners; ++k) {
        const FacetNumber next = across(visible[i], k);
        const auto [known, is_new] = is_visible_.try_emplace(next, false);
        if (is_new && space_.is_outside(*this, next, v)) {
          known->second = true;
          visible.push_back(next);
        }
        if (!known->second) horizon.push_back({visible[i], k});
      }
    }
    std::vector<FacetNumber> made;
    ridges_.clear();
    for (const Ridge& ridge : horizon) made.push_back(make_facet(ridge, v));
    std::vector<VertexNumber> orphans;
    for (const FacetNumber t : visible) {
      orphans.insert(orphans.end(), outside_[t].begin(), outside_[t].end());
      outside_[t] = {};
      corners_[t][0] = kDeadVertex;
      free_.push_back(t);
    }
    distribute(orphans, made);
    to_visit_.insert(to_visit_.end(), made.begin(), made.end());
  }

  // From v to a ridge of the horizon.
  FacetNumber make_facet(const Ridge& ridge, VertexNumber v) {
    const FacetNumber t = create();
    corners_[t] = corners_[ridge.facet];
    corners_[t][ridge.corner] = v;
    const std::uint32_t outer = across_[ridge.facet][ridge.corner];
    link(t, ridge.corner, outer / 8, outer % 8);
    for (unsigned k = 0; k < kCorners; ++k) {
      if (k != ridge.corner) link_or_keep(t, k, v);
    }
    return t;
  }

  // The new facet that shares the ridge opposite to corner k of t, with the new vertex v, may be
  // there already.
  void link_or_keep(FacetNumber t, unsigned k, VertexNumber v) {
    RidgeKey key{};
    unsigned size = 0;
    for (unsigned i = 0; i < kCorners; ++i) {
      const VertexNumber vertex = corners_[t][i];
      if (i != k && vertex != v) key[size++] = vertex;
    }
    std::ranges::sort(key);
    const auto [mate, is_new] = ridges_.try_emplace(key, 8 * t + k);
    if (!is_new) link(mate->second / 8, mate->second % 8, t, k);
  }

  FacetNumber create() {
    if (!free_.empty()) {
      const FacetNumber t = free_.back();
      free_.pop_back();
      return t;
    }
    corners_.emplace_back();
    across_.emplace_back();
    outside_.emplace_back();
    return static_cast<FacetNumber>(corners_.size() - 1);
  }

  const Space& space_;
  parallel::Progress* progress_;
  std::vector<Corners> corners_;
  std::vector<std::array<std::uint32_t, kCorners>> across_;  // 8 facet + corner
  std::vector<std::vector<VertexNumber>> outside_;           // per facet
  std::vector<FacetNumber> free_, to_visit_;
  std::unordered_map<FacetNumber, bool> is_visible_;
  std::unordered_map<RidgeKey, std::uint32_t, CornersHash> ridges_;
};

}  // namespace delray::delaunay::internal
