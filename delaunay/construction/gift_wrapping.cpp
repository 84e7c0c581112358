// A simplex closes those of its facets that are open and opens the others. Facets without a point
// outside are the hull's.
//
// Degenerate: points on a common ball are decided by the perturbation of conflict.h, by which the
// triangulation is unique and facets of neighbours always match. Flat input has no first simplex.
#include "delaunay/construction/gift_wrapping.h"

#include <vector>

#include "delaunay/construction/wrapping.h"

namespace delray::delaunay::internal {
namespace {

template <int D>
Wrapped<D> wrap_all(const ApexSearch<D>& search, const SimplexCorners<D>& first,
                    parallel::Progress* progress) {
  OpenFacets<D> open;
  std::vector<bool> is_used(search.points().size());
  const auto add = [&](const SimplexCorners<D>& simplex) {
    std::size_t reached = 0;
    for (unsigned k = 0; k <= D; ++k) {
      reached += is_used[simplex[k]] ? 0 : 1;
      is_used[simplex[k]] = true;
      open.toggle(outer_facet<D>(simplex, k));
    }
    if (progress != nullptr) progress->advance(reached);
  };
  Wrapped<D> result;
  result.corners.assign(first.begin(), first.end());
  add(first);
  wrap(search, open, result, add);
  return result;
}

template <int D>
Result wrap_points(PointView<double> points, const Options& options) {
  return construct<D>(points, options, [&](const auto& search, const SimplexCorners<D>& first) {
    return wrap_all<D>(search, first, options.progress);
  });
}

}  // namespace

Result wrap_gifts(PointView<double> points, const Options& options) {
  return options.dim == 2 ? wrap_points<2>(points, options) : wrap_points<3>(points, options);
}

}  // namespace delray::delaunay::internal
