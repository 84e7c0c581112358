// The space of points on a paraboloid: facets of the lower hull are simplices, those that stand
// upright the ghosts beyond the convex hull. A point is outside of one when it is in conflict with
// it, by the perturbation of conflict.h where points are level.
//
// Degenerate: every point that is no duplicate is a vertex of the lower hull.
#include "delaunay/construction/quickhull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "delaunay/construction/apex_search.h"
#include "delaunay/construction/distinct_points.h"
#include "delaunay/construction/quick_hull.h"
#include "delaunay/mesh/stopwatch.h"

namespace delray::delaunay::internal {
namespace {

double determinant_of(std::array<glm::dvec2, 2> rows) {
  return rows[0].x * rows[1].y - rows[0].y * rows[1].x;
}
double determinant_of(std::array<glm::dvec3, 3> rows) {
  return glm::dot(rows[0], glm::cross(rows[1], rows[2]));
}

template <int D>
class LiftedSpace {
 public:
  static constexpr unsigned kCorners = D + 1;
  using Point = Position<D>;
  using Corners = std::array<VertexNumber, kCorners>;

  explicit LiftedSpace(const std::vector<Point>& points) : points_(points) {}

  // A ghost would be negatively oriented with a point inside in the place of infinity.
  void orient(Corners& corners, VertexNumber inner) const {
    const auto infinite = std::ranges::find(corners, kInfiniteVertex);
    if (infinite == corners.end()) return;
    *infinite = inner;
    const bool is_turned = orientation_of(simplex(corners)) > 0;
    *infinite = kInfiniteVertex;
    if (is_turned) std::swap(corners[0], corners[1]);
  }

  template <class Hull>
  bool is_outside(const Hull& hull, std::uint32_t facet, VertexNumber v) const {
    const Corners& corners = hull.corners(facet);
    const auto infinite = std::ranges::find(corners, kInfiniteVertex);
    if (infinite == corners.end()) return is_in_ball(simplex(corners), points_[v]);
    const auto k = static_cast<unsigned>(infinite - corners.begin());
    Corners replaced = corners;
    replaced[k] = v;
    if (const int side = orientation_of(simplex(replaced)); side != 0) return side > 0;
    // On the hull's facet the simplex inside decides.
    return is_in_ball(simplex(hull.corners(hull.across(facet, k))), points_[v]);
  }

  // How far below the simplex's facet of the lifted points v lies, or beyond the ghost's of the
  // hull, but for rounding.
  double height(const Corners& corners, VertexNumber v) const {
    std::array<Point, D + 1> from_q{};
    unsigned infinite = D + 1;
    for (unsigned k = 0; k <= D; ++k) {
      if (corners[k] == kInfiniteVertex) {
        infinite = k;
      } else {
        from_q[k] = points_[corners[k]] - points_[v];
      }
    }
    // By Cramer's rule: the lift at q of the plane through the others is the sum of each one's lift
    // times its barycentric coordinate.
    double lift = 0, volume = 0;
    for (unsigned k = 0; k <= D; ++k) {
      std::array<Point, D> rows;
      for (unsigned i = 0, row = 0; i <= D; ++i) {
        if (i != k) rows[row++] = from_q[i];
      }
      if (infinite <= D) {
        if (k == infinite) return std::abs(determinant_of(rows));
        continue;
      }
      const double part = (k % 2 == 0 ? 1 : -1) * determinant_of(rows);
      lift += part * glm::dot(from_q[k], from_q[k]);
      volume += part;
    }
    return lift / volume;
  }

 private:
  std::array<Point, kCorners> simplex(const Corners& corners) const {
    std::array<Point, kCorners> at;
    for (unsigned k = 0; k < kCorners; ++k) at[k] = points_[corners[k]];
    return at;
  }

  const std::vector<Point>& points_;
};

template <int D>
void extract_lower_hull(const QuickHull<LiftedSpace<D>>& hull,
                        const std::vector<std::uint32_t>& rows, Triangulation& result) {
  for (std::uint32_t facet = 0; facet < hull.size(); ++facet) {
    if (hull.is_dead(facet)) continue;
    const auto& corners = hull.corners(facet);
    if (std::ranges::find(corners, kInfiniteVertex) != corners.end()) {
      ++result.hull_facets;
    } else {
      for (const VertexNumber v : corners) result.vertices.push_back(rows[v]);
    }
  }
}

template <int D>
Result triangulate_lifted(PointView<double> input, const Options& options) {
  Stopwatch watch;
  const DistinctOrder<D> distinct = distinct_points<D>(input);
  const std::uint64_t n = distinct.points.size();
  if (options.progress != nullptr) options.progress->advance(input.size() - n);
  Result result;
  result.statistics.order = watch.lap();
  result.triangulation.dim = D;
  result.triangulation.distinct = n;
  const auto first = first_simplex<D>(distinct.points);
  if (!first) return result;
  std::array<VertexNumber, D + 2> with_infinity{};
  std::ranges::copy(*first, with_infinity.begin());
  with_infinity[D + 1] = kInfiniteVertex;
  std::vector<VertexNumber> others;
  for (VertexNumber v = 0; v < n; ++v) {
    if (std::ranges::find(*first, v) == first->end()) others.push_back(v);
  }
  if (options.progress != nullptr) options.progress->advance(first->size());
  const LiftedSpace<D> space(distinct.points);
  QuickHull<LiftedSpace<D>> hull(space, with_infinity, others, options.progress);
  hull.run();
  result.statistics.subdivide = watch.lap();
  extract_lower_hull<D>(hull, distinct.rows, result.triangulation);
  result.statistics.extract = watch.lap();
  return result;
}

}  // namespace

Result lower_hull_of_lifted(PointView<double> points, const Options& options) {
  return options.dim == 2 ? triangulate_lifted<2>(points, options)
                          : triangulate_lifted<3>(points, options);
}

}  // namespace delray::delaunay::internal
