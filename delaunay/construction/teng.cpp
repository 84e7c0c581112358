// A facet belongs to the area of its lowest corner, a simplex likewise. A round has three steps,
// each of all areas at once: find simplices on the own open facets and send them to the areas that
// they belong to; drop the copies that came, keep one and send its facets on; open or close the
// facets that came. Copies of a simplex always come in one round, as all its facets that are open
// are worked on.
//
// Degenerate: as gift-wrapping.
#include "delaunay/construction/teng.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "delaunay/construction/point_areas.h"
#include "delaunay/construction/wrapping.h"
#include "delaunay/mesh/with_threads.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {
namespace {

template <int D>
class Rounds {
 public:
  Rounds(const ApexSearch<D>& search, const Options& options)
      : search_(search),
        options_(options),
        area_of_(areas_of(search.points(), options.threads)),
        areas_(static_cast<std::size_t>(options.threads)) {
    for (Area& area : areas_) {
      area.simplices.resize(areas_.size());
      area.facets.resize(areas_.size());
    }
  }

  Wrapped<D> run(const SimplexCorners<D>& first) {
    areas_[area_of(first)].simplices[area_of(first)].push_back(first);
    bool any_open = true;
    while (any_open) {
      for_each_area([&](std::size_t i) { keep(i); });
      for_each_area([&](std::size_t i) { toggle(i); });
      any_open = std::ranges::any_of(areas_, [](const Area& area) { return !area.open.empty(); });
      for_each_area([&](std::size_t i) { find(areas_[i]); });
      open_ = 0;
      for (const Area& area : areas_) open_ += area.worked_on;
      report();
    }
    return gather();
  }

 private:
  struct Area {
    OpenFacets<D> open;
    std::size_t worked_on = 0;  // facets, in the last round
    // By the area that they are for.
    std::vector<std::vector<SimplexCorners<D>>> simplices;
    std::vector<std::vector<FacetCorners<D>>> facets;
    Wrapped<D> made;
  };

  template <std::size_t N>
  std::size_t area_of(const std::array<VertexNumber, N>& corners) const {
    return area_of_[*std::ranges::min_element(corners)];
  }
  template <class F>
  void for_each_area(const F& f) const {
    if (areas_.size() > 1 && open_ > kFewFacets) {
      return parallel::parallel_for(0, areas_.size(), 1, f);
    }
    for (std::size_t i = 0; i < areas_.size(); ++i) f(i);
  }

  // The simplices that came for an area, each once.
  void keep(std::size_t to) {
    std::vector<std::pair<SimplexCorners<D>, SimplexCorners<D>>> came;  // ascending, as made
    for (Area& from : areas_) {
      for (const SimplexCorners<D>& simplex : from.simplices[to]) {
        came.emplace_back(simplex, simplex);
        std::ranges::sort(came.back().first);
      }
      from.simplices[to].clear();
    }
    std::ranges::sort(came);
    Area& area = areas_[to];
    for (std::size_t i = 0; i < came.size(); ++i) {
      if (i > 0 && came[i].first == came[i - 1].first) continue;
      const SimplexCorners<D>& simplex = came[i].second;
      area.made.corners.insert(area.made.corners.end(), simplex.begin(), simplex.end());
      area.made.created_by.push_back(static_cast<std::uint16_t>(parallel::arena_thread()));
      for (unsigned k = 0; k <= D; ++k) {
        const FacetCorners<D> facet = outer_facet<D>(simplex, k);
        area.facets[area_of(facet)].push_back(facet);
      }
    }
  }

  void toggle(std::size_t to) {
    for (Area& from : areas_) {
      for (const FacetCorners<D>& facet : from.facets[to]) areas_[to].open.toggle(facet);
      from.facets[to].clear();
    }
  }

  static constexpr std::size_t kFewFacets = 64;  // not worth waking threads

  // Hull facets close; others do when their simplex has been kept.
  void find(Area& area) {
    const std::vector<FacetCorners<D>> facets = area.open.all();
    area.worked_on = facets.size();
    for (const FacetCorners<D>& facet : facets) {
      if (const auto simplex = simplex_on<D>(search_, facet)) {
        area.simplices[area_of(*simplex)].push_back(*simplex);
      } else {
        area.open.toggle(facet);
        ++area.made.hull_facets;
      }
    }
  }

  // About as many points are reached as simplices made, halved in the plane, and a seventh in
  // space.
  void report() {
    if (options_.progress == nullptr) return;
    std::size_t simplices = 0;
    for (const Area& area : areas_) simplices += area.made.created_by.size();
    const std::size_t reached = std::min(search_.points().size(), simplices / (D == 2 ? 2 : 7));
    options_.progress->advance(reached - reported_);
    reported_ = reached;
  }

  Wrapped<D> gather() {
    Wrapped<D> result;
    for (Area& area : areas_) {
      result.corners.insert(result.corners.end(), area.made.corners.begin(),
                            area.made.corners.end());
      result.hull_facets += area.made.hull_facets;
      result.created_by.insert(result.created_by.end(), area.made.created_by.begin(),
                               area.made.created_by.end());
      area.made = {};
    }
    if (areas_.size() == 1 || !options_.created_by) result.created_by.clear();
    if (options_.progress != nullptr) {
      options_.progress->advance(search_.points().size() - reported_);
    }
    return result;
  }

  const ApexSearch<D>& search_;
  const Options& options_;
  std::vector<std::uint16_t> area_of_;  // per vertex
  std::vector<Area> areas_;
  std::size_t open_ = 0;  // facets, in the last round
  std::size_t reported_ = 0;
};

template <int D>
Result construct_rounds(PointView<double> points, const Options& options) {
  return construct<D>(points, options, [&](const auto& search, const SimplexCorners<D>& first) {
    return Rounds<D>(search, options).run(first);
  });
}

}  // namespace

Result teng(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] {
    return options.dim == 2 ? construct_rounds<2>(points, options)
                            : construct_rounds<3>(points, options);
  });
}

}  // namespace delray::delaunay::internal
