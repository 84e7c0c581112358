// Points and tops of circles come in the exact order of their heights, see sweep_order.h; of points
// of one height the leftmost first, and a circle's top before a point of its height.
//
// Degenerate: the lowest row of points makes arcs beside each other. Points on a common circle give
// any triangulation of their polygon; flips at the end turn it into the one of the perturbation.
#include "delaunay/construction/sweep.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "delaunay/construction/beach_line.h"
#include "delaunay/construction/distinct_points.h"
#include "delaunay/construction/flip_edges.h"
#include "delaunay/construction/sweep_order.h"
#include "delaunay/mesh/build_mesh.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

class Sweep {
 public:
  explicit Sweep(const std::vector<glm::dvec2>& points) : points_(points) {}

  // Three corners a triangle, counterclockwise.
  std::vector<VertexNumber> run(parallel::Progress* progress) {
    std::vector<VertexNumber> sites(points_.size());
    std::iota(sites.begin(), sites.end(), 0U);
    std::ranges::sort(sites, [&](VertexNumber a, VertexNumber b) {
      const glm::dvec2 &p = points_[a], &q = points_[b];
      return p.y < q.y || (p.y == q.y && p.x < q.x);
    });
    for (const VertexNumber site : sites) {
      while (!circles_.empty() && circles_.top().top.compare(points_[site].y) <= 0) close_arc();
      split_arc(site);
      if (progress != nullptr) progress->advance();
    }
    while (!circles_.empty()) close_arc();
    return std::move(corners_);
  }

 private:
  struct CircleEvent {
    TopOfCircle top;
    ArcNumber arc;  // shrinks to nothing
    std::uint64_t life;
  };
  struct IsLater {
    bool operator()(const CircleEvent& a, const CircleEvent& b) const {
      const int order = a.top.compare(b.top);
      return order != 0 ? order > 0 : a.life > b.life;
    }
  };

  const glm::dvec2& at(ArcNumber arc) const { return points_[beach_.site(arc)]; }

  void split_arc(VertexNumber site) {
    if (beach_.empty()) {
      beach_.insert_after(kNoArc, site);
      return;
    }
    const glm::dvec2& s = points_[site];
    const ArcNumber arc = beach_.find(
        [&](ArcNumber left, ArcNumber right) { return meet_left_of(at(left), at(right), s); });
    const ArcNumber made = beach_.insert_after(arc, site);
    // In the lowest row no arc has a width yet.
    if (at(arc).y == s.y) return;
    const ArcNumber rest = beach_.insert_after(made, beach_.site(arc));
    watch(arc);
    watch(rest);
  }

  // Waits for the circle of an arc and its neighbours, and for no other that the arc had before.
  void watch(ArcNumber arc) {
    beach_.renew(arc);
    const ArcNumber left = beach_.previous(arc), right = beach_.next(arc);
    if (left == kNoArc || right == kNoArc) return;
    if (orient2d(at(left), at(arc), at(right)) <= 0) return;
    circles_.push({TopOfCircle(at(left), at(arc), at(right)), arc, beach_.life(arc)});
  }

  void close_arc() {
    const CircleEvent event = circles_.top();
    circles_.pop();
    const ArcNumber arc = event.arc;
    if (beach_.life(arc) != event.life) return;
    const ArcNumber left = beach_.previous(arc), right = beach_.next(arc);
    corners_.insert(corners_.end(), {beach_.site(left), beach_.site(arc), beach_.site(right)});
    beach_.remove(arc);
    watch(left);
    watch(right);
  }

  const std::vector<glm::dvec2>& points_;
  BeachLine beach_;
  std::priority_queue<CircleEvent, std::vector<CircleEvent>, IsLater> circles_;
  std::vector<VertexNumber> corners_;
};

}  // namespace

Result sweep(PointView<double> input, const Options& options) {
  Stopwatch watch;
  const DistinctOrder<2> distinct = distinct_points<2>(input);
  const std::size_t n = distinct.points.size();
  if (options.progress != nullptr) options.progress->advance(input.size() - n);
  Statistics seconds;
  seconds.order = watch.lap();
  Triangulation triangles;
  triangles.distinct = n;
  triangles.vertices = Sweep(distinct.points).run(options.progress);
  // By Euler's formula; flat points have no triangle.
  const std::uint64_t count = triangles.vertices.size() / 3;
  triangles.hull_facets = count == 0 ? 0 : 2 * n - 2 - count;
  seconds.subdivide = watch.lap();
  BuiltMesh<2> built = mesh_of<2>(triangles, n);
  flip_to_delaunay(built.mesh, distinct.points);
  seconds.legalize = watch.lap();
  Result result = extract(std::move(built.mesh), std::span<const std::uint32_t>(distinct.rows));
  result.triangulation.distinct = n;
  seconds.extract = watch.lap();
  result.statistics = seconds;
  return result;
}

}  // namespace delray::delaunay::internal
