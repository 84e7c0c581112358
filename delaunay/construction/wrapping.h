// Open facets and the simplices that close them: what the methods of incremental construction
// share.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "delaunay/construction/apex_search.h"
#include "delaunay/construction/corners_hash.h"
#include "delaunay/construction/distinct_points.h"
#include "delaunay/construction/first_delaunay.h"
#include "delaunay/mesh/facets.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

template <int D>
using SimplexCorners = std::array<VertexNumber, D + 1>;  // positively oriented
// Its outside is as that of ApexSearch::Facet.
template <int D>
using FacetCorners = std::array<VertexNumber, D>;

// The facet opposite to corner k, its outside where the simplex is not.
template <int D>
FacetCorners<D> outer_facet(const SimplexCorners<D>& simplex, unsigned k) {
  const std::span<const int> order = facet_corners(D, k);
  FacetCorners<D> facet;
  for (unsigned i = 0; i < D; ++i) facet[i] = simplex[static_cast<unsigned>(order[i])];
  if constexpr (D == 2) std::swap(facet[0], facet[1]);
  return facet;
}

// The simplex on the outside of a facet; nothing if the facet is the hull's.
template <int D>
std::optional<SimplexCorners<D>> simplex_on(const ApexSearch<D>& search,
                                            const FacetCorners<D>& facet) {
  typename ApexSearch<D>::Facet corners;
  for (unsigned k = 0; k < D; ++k) corners[k] = search.points()[facet[k]];
  const std::optional<VertexNumber> apex = search.find(corners);
  if (!apex) return std::nullopt;
  SimplexCorners<D> simplex;
  std::ranges::copy(facet, simplex.begin());
  simplex[D] = *apex;
  return simplex;
}

// Facets on whose outside a simplex is still to be made.
template <int D>
class OpenFacets {
 public:
  bool empty() const { return open_.empty(); }
  // Opens a facet, or closes it if its other side opened it.
  void toggle(const FacetCorners<D>& facet) {
    const FacetCorners<D> key = key_of(facet);
    if (open_.erase(key) != 0) return;
    open_.insert(key);
    stack_.push_back(facet);
  }
  // One of them, the last that was opened; it stays open. REQUIRES: not empty.
  FacetCorners<D> last() {
    while (!open_.contains(key_of(stack_.back()))) stack_.pop_back();
    return stack_.back();
  }
  // All, and forgets those that were closed. O(open and closed since the last call).
  std::vector<FacetCorners<D>> all() {
    std::vector<FacetCorners<D>> facets;
    std::unordered_set<FacetCorners<D>, CornersHash> seen;
    for (const FacetCorners<D>& facet : stack_) {
      if (open_.contains(key_of(facet)) && seen.insert(key_of(facet)).second) {
        facets.push_back(facet);
      }
    }
    stack_ = facets;
    return facets;
  }

 private:
  static FacetCorners<D> key_of(FacetCorners<D> facet) {
    std::ranges::sort(facet);
    return facet;
  }

  std::unordered_set<FacetCorners<D>, CornersHash> open_;
  std::vector<FacetCorners<D>> stack_;  // some were closed since
};

// What was made.
template <int D>
struct Wrapped {
  std::vector<VertexNumber> corners;  // D + 1 a simplex
  std::uint64_t hull_facets = 0;
  std::vector<std::uint16_t> created_by;  // of each simplex, or empty
};

// Makes the simplices on the open facets until none is open; added(simplex) toggles the facets of
// each.
template <int D, class Added>
void wrap(const ApexSearch<D>& search, OpenFacets<D>& open, Wrapped<D>& result,
          const Added& added) {
  while (!open.empty()) {
    const FacetCorners<D> facet = open.last();
    if (const auto simplex = simplex_on<D>(search, facet)) {
      result.corners.insert(result.corners.end(), simplex->begin(), simplex->end());
      added(*simplex);
    } else {
      open.toggle(facet);
      ++result.hull_facets;
    }
  }
}

// From points to result by make(search, first), Wrapped with `first` among what it made.
template <int D, class Make>
Result construct(PointView<double> input, const Options& options, const Make& make) {
  Result result;
  Stopwatch watch;
  DistinctOrder<D> distinct = distinct_points<D>(input);
  result.triangulation.dim = D;
  result.triangulation.distinct = distinct.points.size();
  if (options.progress != nullptr) {
    options.progress->advance(input.size() - distinct.points.size());
  }
  const ApexSearch<D> search(std::move(distinct.points));
  result.statistics.order = watch.lap();
  if (const auto first = first_delaunay_simplex<D>(search)) {
    Wrapped<D> wrapped = make(search, *first);
    result.statistics.subdivide = watch.lap();
    result.triangulation.hull_facets = wrapped.hull_facets;
    result.triangulation.vertices = std::move(wrapped.corners);
    for (std::uint32_t& vertex : result.triangulation.vertices) vertex = distinct.rows[vertex];
    result.created_by = std::move(wrapped.created_by);
    result.statistics.extract = watch.lap();
  }
  return result;
}

}  // namespace delray::delaunay::internal
