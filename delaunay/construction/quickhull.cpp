// The farthest point of a facet is found by heights in doubles: which point is next decides how
// long it takes, and nothing else.
//
// Degenerate: every point that is no duplicate is a vertex of the lower hull; the perturbation of
// conflict.h decides between points that are level.
#include "delaunay/construction/quickhull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "delaunay/construction/corners_hash.h"
#include "delaunay/construction/distinct_points.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

double determinant_of(std::array<glm::dvec2, 2> rows) {
  return rows[0].x * rows[1].y - rows[0].y * rows[1].x;
}
double determinant_of(std::array<glm::dvec3, 3> rows) {
  return glm::dot(rows[0], glm::cross(rows[1], rows[2]));
}

template <int D>
class LiftedHull {
 public:
  using Point = Position<D>;

  LiftedHull(const std::vector<Point>& points, const std::array<VertexNumber, D + 1>& first,
             parallel::Progress* progress)
      : points_(points), progress_(progress), mesh_(8 * (D + 2)), outside_(D + 2) {
    start_mesh(mesh_, first);
    std::vector<VertexNumber> others;
    for (VertexNumber v = 0; v < points.size(); ++v) {
      if (std::ranges::find(first, v) == first.end()) others.push_back(v);
    }
    if (progress_ != nullptr) progress_->advance(first.size());
    std::vector<SimplexNumber> all(D + 2);
    for (SimplexNumber t = 0; t < all.size(); ++t) all[t] = t;
    distribute(others, all);
    to_visit_ = std::move(all);
  }

  Mesh<D> run() {
    while (!to_visit_.empty()) {
      const SimplexNumber facet = to_visit_.back();
      if (mesh_.is_dead(facet) || outside_[facet].empty()) {
        to_visit_.pop_back();
        continue;
      }
      add(take_farthest(facet), facet);
      if (progress_ != nullptr) progress_->advance();
    }
    mesh_.shrink(used_);
    return std::move(mesh_);
  }

 private:
  struct Ridge {
    SimplexNumber facet;
    unsigned corner;
  };
  using RidgeKey = std::array<VertexNumber, D - 1>;

  // Each to the first facet of which it is outside.
  void distribute(const std::vector<VertexNumber>& vertices,
                  const std::vector<SimplexNumber>& facets) {
    for (const VertexNumber v : vertices) {
      const auto facet = std::ranges::find_if(
          facets, [&](SimplexNumber t) { return conflict(mesh_, points_, t, points_[v]); });
      outside_[*facet].push_back(v);
    }
  }

  // How far below the simplex's facet of the lifted points q lies, or beyond the ghost's of the
  // hull, but for rounding.
  double height(SimplexNumber simplex, const Point& q) const {
    std::array<Point, D + 1> from_q{};
    unsigned infinite = D + 1;
    for (unsigned k = 0; k <= D; ++k) {
      const VertexNumber vertex = mesh_.vertex(corner_of(simplex, k));
      if (vertex == kInfiniteVertex) {
        infinite = k;
      } else {
        from_q[k] = points_[vertex] - q;
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

  VertexNumber take_farthest(SimplexNumber facet) {
    std::vector<VertexNumber>& candidates = outside_[facet];
    std::size_t farthest = 0;
    double most = -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double h = height(facet, points_[candidates[i]]);
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
  void add(VertexNumber v, SimplexNumber seen) {
    std::vector<SimplexNumber> visible = {seen};
    std::vector<Ridge> horizon;
    is_visible_[seen] = true;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      for (unsigned k = 0; k <= D; ++k) {
        const SimplexNumber next = simplex_of(mesh_.neighbour(corner_of(visible[i], k)));
        const auto [known, is_new] = is_visible_.try_emplace(next, false);
        if (is_new && conflict(mesh_, points_, next, points_[v])) {
          known->second = true;
          visible.push_back(next);
        }
        if (!known->second) horizon.push_back({visible[i], k});
      }
    }
    is_visible_.clear();

    std::vector<SimplexNumber> made;
    ridges_.clear();
    for (const Ridge& ridge : horizon) {
      const SimplexNumber t = create();
      for (unsigned k = 0; k <= D; ++k) {
        mesh_.set_vertex(corner_of(t, k),
                         k == ridge.corner ? v : mesh_.vertex(corner_of(ridge.facet, k)));
      }
      mesh_.link(corner_of(t, ridge.corner), mesh_.neighbour(corner_of(ridge.facet, ridge.corner)));
      for (unsigned k = 0; k <= D; ++k) {
        if (k != ridge.corner) link_or_keep(t, k, v);
      }
      made.push_back(t);
    }
    std::vector<VertexNumber> orphans;
    for (const SimplexNumber t : visible) {
      orphans.insert(orphans.end(), outside_[t].begin(), outside_[t].end());
      outside_[t] = {};
      mesh_.set_vertex(corner_of(t, 0), kDeadVertex);
      free_.push_back(t);
    }
    distribute(orphans, made);
    to_visit_.insert(to_visit_.end(), made.begin(), made.end());
  }

  // The new facet that shares the ridge opposite to corner k of t, with the new vertex v, may be
  // there already.
  void link_or_keep(SimplexNumber t, unsigned k, VertexNumber v) {
    RidgeKey key;
    unsigned size = 0;
    for (unsigned i = 0; i <= D; ++i) {
      const VertexNumber vertex = mesh_.vertex(corner_of(t, i));
      if (i != k && vertex != v) key[size++] = vertex;
    }
    std::ranges::sort(key);
    const auto [mate, is_new] = ridges_.try_emplace(key, corner_of(t, k));
    if (!is_new) mesh_.link(mate->second, corner_of(t, k));
  }

  SimplexNumber create() {
    if (!free_.empty()) {
      const SimplexNumber t = free_.back();
      free_.pop_back();
      return t;
    }
    if (used_ == mesh_.size()) mesh_.grow(2 * mesh_.size());
    outside_.emplace_back();
    return used_++;
  }

  const std::vector<Point>& points_;
  parallel::Progress* progress_;
  Mesh<D> mesh_;
  SimplexNumber used_ = D + 2;
  std::vector<SimplexNumber> free_, to_visit_;
  std::vector<std::vector<VertexNumber>> outside_;  // per facet
  std::unordered_map<SimplexNumber, bool> is_visible_;
  std::unordered_map<RidgeKey, CornerNumber, CornersHash> ridges_;
};

template <int D>
Result triangulate_lifted(PointView<double> input, const Options& options) {
  Stopwatch watch;
  const DistinctOrder<D> distinct = distinct_points<D>(input);
  const std::uint64_t n = distinct.points.size();
  if (options.progress != nullptr) options.progress->advance(input.size() - n);
  Statistics seconds;
  seconds.order = watch.lap();
  Result result;
  result.triangulation.dim = D;
  if (const auto first = first_simplex<D>(distinct.points)) {
    Mesh<D> mesh = LiftedHull<D>(distinct.points, *first, options.progress).run();
    seconds.subdivide = watch.lap();
    result = extract(std::move(mesh), std::span<const std::uint32_t>(distinct.rows));
    seconds.extract = watch.lap();
  }
  result.triangulation.distinct = n;
  result.statistics = seconds;
  return result;
}

}  // namespace

Result lower_hull_of_lifted(PointView<double> points, const Options& options) {
  return options.dim == 2 ? triangulate_lifted<2>(points, options)
                          : triangulate_lifted<3>(points, options);
}

}  // namespace delray::delaunay::internal
