// The simplices at a corner hang together by the facets that have it, so that wrapping over facets
// with a corner in the area finds those of all corners that a simplex was found at. A corner
// without any is reached by a visibility walk over simplices that are made on the way and
// forgotten.
//
// Degenerate: as gift-wrapping.
#include "delaunay/construction/incode.h"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <vector>

#include "delaunay/construction/corners_hash.h"
#include "delaunay/construction/point_areas.h"
#include "delaunay/construction/wrapping.h"
#include "delaunay/mesh/with_threads.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {
namespace {

// A thread's work.
template <int D>
class OwnArea {
 public:
  OwnArea(const ApexSearch<D>& search, const std::vector<std::uint16_t>& areas, std::uint16_t area,
          parallel::Progress* progress)
      : search_(search), areas_(areas), area_(area), progress_(progress) {}

  Wrapped<D> run(const SimplexCorners<D>& first) {
    thread_ = static_cast<std::uint16_t>(parallel::arena_thread());
    is_reached_.resize(areas_.size());
    SimplexCorners<D> last = first;
    for (VertexNumber v = 0; v < areas_.size(); ++v) {
      if (areas_[v] != area_ || is_reached_[v]) continue;
      last = walk_to(v, last);
      add(last);
      while (!open_.empty()) make_next();
    }
    return std::move(made_);
  }

 private:
  bool is_own(VertexNumber v) const { return areas_[v] == area_; }

  void add(const SimplexCorners<D>& simplex) {
    made_.corners.insert(made_.corners.end(), simplex.begin(), simplex.end());
    made_.created_by.push_back(thread_);
    std::size_t reached = 0;
    for (unsigned k = 0; k <= D; ++k) {
      if (is_own(simplex[k]) && !is_reached_[simplex[k]]) {
        is_reached_[simplex[k]] = true;
        ++reached;
      }
      const FacetCorners<D> facet = outer_facet<D>(simplex, k);
      if (std::ranges::any_of(facet, [&](VertexNumber v) { return is_own(v); })) {
        open_.toggle(facet);
      }
    }
    if (progress_ != nullptr) progress_->advance(reached);
  }

  void make_next() {
    const FacetCorners<D> facet = open_.last();
    if (const auto simplex = simplex_on<D>(search_, facet)) return add(*simplex);
    open_.toggle(facet);
    // All that have a corner of it find it.
    made_.hull_facets += is_own(*std::ranges::min_element(facet)) ? 1 : 0;
  }

  // The first simplex on the way with v as a corner.
  SimplexCorners<D> walk_to(VertexNumber v, SimplexCorners<D> simplex) const {
    while (std::ranges::find(simplex, v) == simplex.end()) {
      for (unsigned k = 0; k <= D; ++k) {
        const FacetCorners<D> facet = outer_facet<D>(simplex, k);
        std::array<Position<D>, D + 1> beyond;
        for (unsigned i = 0; i < D; ++i) beyond[i] = search_.points()[facet[i]];
        beyond[D] = search_.points()[v];
        if (orientation_of(beyond) <= 0) continue;
        simplex = *simplex_on<D>(search_, facet);
        break;
      }
    }
    return simplex;
  }

  const ApexSearch<D>& search_;
  const std::vector<std::uint16_t>& areas_;
  std::uint16_t area_, thread_ = 0;
  parallel::Progress* progress_;
  std::vector<bool> is_reached_;  // own vertices
  OpenFacets<D> open_;
  Wrapped<D> made_;
};

// One after the other: a simplex with corners in several areas is kept once.
template <int D>
Wrapped<D> without_copies(std::vector<Wrapped<D>> parts, const std::vector<std::uint16_t>& areas) {
  std::unordered_set<SimplexCorners<D>, CornersHash> shared;
  Wrapped<D> result;
  for (Wrapped<D>& part : parts) {
    result.hull_facets += part.hull_facets;
    for (std::size_t t = 0; t < part.created_by.size(); ++t) {
      SimplexCorners<D> simplex;
      std::copy_n(part.corners.begin() + static_cast<std::ptrdiff_t>(t * (D + 1)), D + 1,
                  simplex.begin());
      SimplexCorners<D> key = simplex;
      std::ranges::sort(key);
      const bool is_shared = std::ranges::any_of(
          simplex, [&](VertexNumber v) { return areas[v] != areas[simplex[0]]; });
      if (is_shared && !shared.insert(key).second) continue;
      result.corners.insert(result.corners.end(), simplex.begin(), simplex.end());
      result.created_by.push_back(part.created_by[t]);
    }
    part = {};
  }
  return result;
}

template <int D>
Result construct_areas(PointView<double> points, const Options& options) {
  return construct<D>(points, options, [&](const auto& search, const SimplexCorners<D>& first) {
    const auto count = static_cast<std::size_t>(options.threads);
    const std::vector<std::uint16_t> areas = areas_of(search.points(), options.threads);
    std::vector<Wrapped<D>> parts(count);
    const auto work = [&](std::size_t area) {
      parts[area] =
          OwnArea<D>(search, areas, static_cast<std::uint16_t>(area), options.progress).run(first);
    };
    if (count > 1) {
      parallel::parallel_for(0, count, 1, work);
    } else {
      work(0);
    }
    Wrapped<D> result = without_copies<D>(std::move(parts), areas);
    if (count == 1 || !options.created_by) result.created_by.clear();
    return result;
  });
}

}  // namespace

Result incode(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] {
    return options.dim == 2 ? construct_areas<2>(points, options)
                            : construct_areas<3>(points, options);
  });
}

}  // namespace delray::delaunay::internal
