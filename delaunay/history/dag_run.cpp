// Before the insertion: points are planned for the threads and copied in that order, and the
// history starts with the first simplex and the ghosts around it. After it: live finite leaves
// become the result, collected by several threads and joined in order.
#include "delaunay/history/dag_run.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "delaunay/history/dag_location.h"
#include "delaunay/insertion/insertion_start.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/predicates/conflict.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

// Connected sets of live finite leaves that one thread made.
template <int D>
std::uint64_t count_fragments(const Dag<D>& dag) {
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
      for (unsigned k = 0; k <= D; ++k) {
        const NodeNumber next = simplex_of(dag.neighbour(corner_of(node, k)));
        if (seen[next] || dag.is_ghost(next) || dag.created_by(next) != dag.created_by(start))
          continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
  }
  return fragments;
}

// Calls f(i, first, last) for the threads' shares [first, last) of [0, n).
template <class F>
void in_parts(std::size_t n, std::size_t threads, F&& f) {
  // A thread takes about as long to start as to look at so many nodes.
  constexpr std::size_t kPerThread = 16384;
  if (n < threads * kPerThread) return f(std::size_t{0}, std::size_t{0}, n);
  parallel::Team team;
  team.run(threads, [&](std::size_t i) { f(i, n * i / threads, n * (i + 1) / threads); });
}

}  // namespace

template <int D>
DagRun<D>::DagRun(PointView<double> input, const Options& wanted, std::size_t parts)
    : options(wanted), dag_(kNodesPerPoint * input.size(), kLeavesPerPoint * input.size()) {
  Stopwatch watch;
  const auto threads = static_cast<std::size_t>(options.threads);
  const std::vector<Point> points = positions<D>(input);
  Plan plan = make_plan(std::span<const Point>(points), parts, options.split, options.order,
                        options.seed, threads);
  points_.resize(points.size());
  in_parts(points.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) points_[i] = points[plan.points[i]];
  });
  rows_ = std::move(plan.points);
  begins_ = std::move(plan.begins);
  first_ = first_simplex<D>(points_);
  if (first_) start_dag();
  if (options.statistics) statistics.order = watch.lap();
}

template <int D>
void DagRun<D>::start_dag() {
  dag_.allocate(0);
  const RecordNumber record = dag_.allocate_records();
  dag_.set_leaf(0, *first_, record, 0);
  for (unsigned k = 0; k <= D; ++k) {
    // The infinite vertex lies on the other side of the facet, so two others change places.
    std::array<VertexNumber, D + 1> ghost = *first_;
    ghost[k] = kInfiniteVertex;
    std::swap(ghost[(k + 1) % (D + 1)], ghost[(k + 2) % (D + 1)]);
    dag_.set_leaf(1 + k, ghost, record + 1 + k, 0);
  }
  const auto corner_with = [&](NodeNumber node, VertexNumber vertex) {
    CornerNumber corner = corner_of(node, 0);
    while (dag_.vertex(corner) != vertex) ++corner;
    return corner;
  };
  const auto link = [&](CornerNumber a, CornerNumber b) {
    dag_.set_neighbour(a, b);
    dag_.set_neighbour(b, a);
  };
  for (unsigned k = 0; k <= D; ++k) {
    link(corner_with(1 + k, kInfiniteVertex), corner_of(0, k));
    for (unsigned j = 0; j < k; ++j) {
      link(corner_with(1 + k, (*first_)[j]), corner_with(1 + j, (*first_)[k]));
    }
  }
  for (NodeNumber node = kRoots<D>; node < Dag<D>::kCacheSize; ++node) dag_.abandon(node);
}

template <int D>
void DagRun<D>::merge(VertexNumber vertex, VertexNumber point) {
  // Rows of points that are not vertices never change.
  const std::uint32_t row = rows_[point];
  std::atomic_ref<std::uint32_t> lowest(rows_[vertex]);
  std::uint32_t before = lowest.load(std::memory_order_relaxed);
  while (row < before && !lowest.compare_exchange_weak(before, row, std::memory_order_relaxed)) {
  }
  duplicates_.fetch_add(1, std::memory_order_relaxed);
}

template <int D>
Result DagRun<D>::leaves() const {
  Result result;
  result.triangulation.dim = D;
  if (is_flat()) return result;
  struct Share {
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint16_t> created_by;
    std::uint64_t ghosts = 0;
  };
  const auto threads = static_cast<std::size_t>(options.threads);
  std::vector<Share> shares(threads);
  in_parts(dag_.size(), threads, [&](std::size_t i, std::size_t first, std::size_t last) {
    Share own;
    own.vertices.reserve((last - first) * (D + 1) / 4);
    for (auto node = static_cast<NodeNumber>(first); node < last; ++node) {
      if (!dag_.is_live(node)) continue;
      if (dag_.is_ghost(node)) {
        ++own.ghosts;
        continue;
      }
      for (unsigned k = 0; k <= D; ++k) {
        own.vertices.push_back(rows_[dag_.vertex(corner_of(node, k))]);
      }
      if (options.created_by) {
        own.created_by.push_back(static_cast<std::uint16_t>(dag_.created_by(node)));
      }
    }
    shares[i] = std::move(own);
  });
  std::vector<std::size_t> begins = {0};
  std::uint64_t ghosts = 0;
  for (const Share& share : shares) {
    begins.push_back(begins.back() + share.vertices.size());
    ghosts += share.ghosts;
  }
  // The first share's memory becomes the result's, and most of it already is where it belongs.
  std::vector<std::uint32_t>& vertices = result.triangulation.vertices;
  vertices = std::move(shares[0].vertices);
  vertices.reserve(begins.back());
  for (std::size_t i = 1; i < shares.size(); ++i) {
    vertices.insert(vertices.end(), shares[i].vertices.begin(), shares[i].vertices.end());
  }
  if (options.created_by) {
    for (const Share& share : shares) {
      result.created_by.insert(result.created_by.end(), share.created_by.begin(),
                               share.created_by.end());
    }
  }
  result.triangulation.hull_facets = ghosts;
  return result;
}

template <int D>
Result DagRun<D>::finish() {
  Stopwatch watch;
  Result result = leaves();
  result.triangulation.distinct =
      is_flat() ? count_distinct(points_) : points_.size() - duplicates_.load();
  if (options.statistics) {
    statistics.extract += watch.lap();
    if (!is_flat()) {
      for (NodeNumber node = 0; node < dag_.size(); ++node) {
        statistics.dag_nodes += dag_.is_abandoned(node) ? 0 : 1;
      }
      statistics.dag_node_bytes = dag_.bytes() / statistics.dag_nodes;
      statistics.synchronization.fragments = count_fragments(dag_);
    }
  }
  result.statistics = statistics;
  return result;
}

template class DagRun<2>;
template class DagRun<3>;

}  // namespace delray::delaunay::internal
