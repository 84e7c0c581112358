// The space of plain points. A point is outside of a facet when it is beyond its hyperplane; on the
// hyperplane, when it is in the ball of the facet and of any point off it: such balls meet the
// hyperplane in the circumsphere of the facet, and the perturbation gives to all of them what it
// gives within the hyperplane.
#include "delaunay/dimensions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "delaunay/construction/quick_hull.h"
#include "delaunay/dimensions/determinants.h"
#include "delaunay/dimensions/places.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;

// By elimination. The sign is of no use.
template <int D>
double size_of_determinant(std::array<std::array<double, D>, D> rows) {
  double product = 1;
  for (std::size_t i = 0; i < D; ++i) {
    std::size_t pivot = i;
    for (std::size_t j = i + 1; j < D; ++j) {
      if (std::abs(rows[j][i]) > std::abs(rows[pivot][i])) pivot = j;
    }
    std::swap(rows[i], rows[pivot]);
    if (rows[i][i] == 0) return 0;
    product *= rows[i][i];
    for (std::size_t j = i + 1; j < D; ++j) {
      const double factor = rows[j][i] / rows[i][i];
      for (std::size_t k = i; k < D; ++k) rows[j][k] -= factor * rows[i][k];
    }
  }
  return std::abs(product);
}

template <int D>
class PlainSpace {
 public:
  static constexpr unsigned kCorners = D;
  using Corners = std::array<VertexNumber, kCorners>;

  PlainSpace(const std::vector<PlaceNd<D>>& places, const std::array<VertexNumber, D + 1>& first)
      : places_(places), first_(first) {}

  void orient(Corners& corners, VertexNumber inner) const {
    if (side_of(corners, inner) > 0) std::swap(corners[0], corners[1]);
  }

  template <class Hull>
  bool is_outside(const Hull& hull, std::uint32_t facet, VertexNumber v) const {
    const Corners& corners = hull.corners(facet);
    if (const int side = side_of(corners, v); side != 0) return side > 0;
    const VertexNumber off = *std::ranges::find_if(
        first_, [&](VertexNumber first) { return side_of(corners, first) != 0; });
    // That is inside: two corners are swapped.
    auto simplex = with(corners, off);
    std::swap(simplex[0], simplex[1]);
    return internal::conflict_nd<D>(simplex, places_[v]);
  }

  double height(const Corners& corners, VertexNumber v) const {
    std::array<std::array<double, D>, D> rows;
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t k = 0; k < D; ++k) rows[i][k] = places_[corners[i]][k] - places_[v][k];
    }
    return size_of_determinant<D>(rows);
  }

 private:
  std::array<const PlaceNd<D>*, D + 1> with(const Corners& corners, VertexNumber v) const {
    std::array<const PlaceNd<D>*, D + 1> simplex;
    for (std::size_t i = 0; i < D; ++i) simplex[i] = &places_[corners[i]];
    simplex[D] = &places_[v];
    return simplex;
  }
  int side_of(const Corners& corners, VertexNumber v) const {
    return internal::orientation_nd<D>(with(corners, v));
  }

  const std::vector<PlaceNd<D>>& places_;
  std::array<VertexNumber, D + 1> first_;
};

template <int D>
ConvexHull hull_in(const PointView<double>& points) {
  const std::vector<PlaceNd<D>> places = internal::places_of<D>(points);
  std::vector<std::uint32_t> rows = internal::distinct_rows<D>(places);
  ConvexHull result;
  result.dim = D;
  result.distinct = rows.size();
  if (!internal::bring_spanning_to_front<D>(places, rows)) return result;
  std::array<VertexNumber, D + 1> first;
  std::copy_n(rows.begin(), D + 1, first.begin());
  rows.erase(rows.begin(), rows.begin() + D + 1);
  const PlainSpace<D> space(places, first);
  internal::QuickHull<PlainSpace<D>> hull(space, first, rows, nullptr);
  hull.run();
  for (std::uint32_t facet = 0; facet < hull.size(); ++facet) {
    if (hull.is_dead(facet)) continue;
    auto corners = hull.corners(facet);
    if (D == 2) std::swap(corners[0], corners[1]);
    result.facets.insert(result.facets.end(), corners.begin(), corners.end());
  }
  return result;
}

}  // namespace

ConvexHull convex_hull(PointView<double> points, int dim) {
  switch (dim) {
    case 2:
      return hull_in<2>(points);
    case 3:
      return hull_in<3>(points);
    case 4:
      return hull_in<4>(points);
    default:
      throw std::invalid_argument("convex hulls are of 2 to 4 dimensions, not " +
                                  std::to_string(dim));
  }
}

}  // namespace delray::delaunay
