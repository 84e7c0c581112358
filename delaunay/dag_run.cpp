#include "delaunay/internal/dag_run.h"

#include <algorithm>
#include <utility>

#include "delaunay/conflict.h"
#include "delaunay/internal/finite_points.h"
#include "delaunay/internal/first_triangle.h"
#include "delaunay/internal/stopwatch.h"

namespace delray::delaunay::internal {
namespace {

// Connected sets of live finite leaves that one thread made.
std::uint64_t count_fragments(const Dag<2>& dag) {
  std::uint64_t fragments = 0;
  std::vector<bool> seen(dag.size(), false);
  std::vector<NodeNumber> open;
  for (NodeNumber start = 0; start < dag.size(); ++start) {
    if (seen[start] || !dag.is_live(start) || dag.is_ghost(start)) continue;
    ++fragments;
    seen[start] = true;
    open.push_back(start);
    while (!open.empty()) {
      const NodeNumber node = open.back();
      open.pop_back();
      for (unsigned k = 0; k < 3; ++k) {
        const NodeNumber next = simplex_of(dag.neighbour(corner_of(node, k)));
        if (seen[next] || dag.is_ghost(next) || dag.maker(next) != dag.maker(start)) continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
  }
  return fragments;
}

}  // namespace

DagRun::DagRun(PointView<double> input, const Options& wanted, std::size_t parts)
    : options(wanted) {
  Stopwatch watch;
  const std::vector<glm::dvec2> points = finite_points(input);
  Plan plan = make_plan(points, parts, options.split, options.order, options.seed);
  points_.reserve(points.size());
  for (const std::uint32_t row : plan.points) points_.push_back(points[row]);
  rows_ = std::move(plan.points);
  begins_ = std::move(plan.begins);
  first_ = first_triangle(points_);
  if (first_) start_dag();
  if (options.statistics != nullptr) options.statistics->order = watch.lap();
}

void DagRun::start_dag() {
  dag_.allocate(0);
  dag_.set_leaf(0, *first_, 0);
  for (unsigned k = 0; k < 3; ++k) {
    dag_.set_leaf(1 + k, {(*first_)[(k + 2) % 3], (*first_)[(k + 1) % 3], kInfiniteVertex}, 0);
  }
  const auto link = [&](CornerNumber a, CornerNumber b) {
    dag_.set_neighbour(a, b);
    dag_.set_neighbour(b, a);
  };
  for (unsigned k = 0; k < 3; ++k) {
    link(corner_of(1 + k, 2), corner_of(0, k));
    link(corner_of(1 + k, 1), corner_of(1 + (k + 1) % 3, 0));
  }
  for (NodeNumber node = 4; node < Dag<2>::kCacheSize; ++node) dag_.abandon(node);
}

void DagRun::merge(VertexNumber vertex, VertexNumber point) {
  // Rows of points that are not vertices never change.
  const std::uint32_t row = rows_[point];
  std::atomic_ref<std::uint32_t> lowest(rows_[vertex]);
  std::uint32_t before = lowest.load(std::memory_order_relaxed);
  while (row < before && !lowest.compare_exchange_weak(before, row, std::memory_order_relaxed)) {
  }
  duplicates_.fetch_add(1, std::memory_order_relaxed);
}

Triangulation DagRun::leaves() const {
  Triangulation result;
  if (is_flat()) return result;
  std::uint64_t ghosts = 0;
  for (NodeNumber node = 0; node < dag_.size(); ++node) {
    if (!dag_.is_live(node)) continue;
    if (dag_.is_ghost(node)) {
      ++ghosts;
      continue;
    }
    for (unsigned k = 0; k < 3; ++k) {
      result.vertices.push_back(rows_[dag_.vertex(corner_of(node, k))]);
    }
  }
  result.hull_facets = ghosts;
  return result;
}

Triangulation DagRun::finish() {
  Stopwatch watch;
  Triangulation result = leaves();
  result.distinct = is_flat() ? count_distinct(points_) : points_.size() - duplicates_.load();
  if (options.statistics != nullptr) {
    options.statistics->extract += watch.lap();
    if (!is_flat()) {
      for (NodeNumber node = 0; node < dag_.size(); ++node) {
        options.statistics->dag_nodes += dag_.child(node, 0) != kAbandoned ? 1 : 0;
      }
      options.statistics->synchronization.fragments = count_fragments(dag_);
    }
  }
  return result;
}

}  // namespace delray::delaunay::internal
