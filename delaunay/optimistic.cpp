#include "delaunay/internal/optimistic.h"

#include <mutex>
#include <vector>

#include "delaunay/internal/add_counts.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/insertion_phases.h"
#include "delaunay/internal/leaf_search.h"
#include "delaunay/internal/node_locks.h"
#include "delaunay/internal/point_supply.h"
#include "delaunay/internal/team.h"

namespace delray::delaunay::internal {
namespace {

// Returns whether the point is in; otherwise everything was undone.
template <int D, class Access>
bool insert(DagRun<D>& run, const DagTriangulation<D>& triangulation, NodeNumber leaf,
            VertexNumber vertex, Access& access, std::vector<NodeNumber>& suspects,
            InsertionPhases& phases) {
  // Another thread may have been faster between the location and the lock.
  if (access.acquire({leaf}) != Grant::kGranted || !triangulation.dag.is_leaf(leaf)) return false;
  phases.located();
  const VertexNumber equal = run.equal_vertex(leaf, run.point(vertex));
  if (equal != kInfiniteVertex) {
    run.merge(equal, vertex);
    return true;
  }
  if (subdivide(triangulation, leaf, vertex, access, suspects) != Grant::kGranted) return false;
  phases.subdivided();
  if (legalize(triangulation, access, suspects) != Grant::kGranted) return false;
  phases.legalized();
  return true;
}

template <int D, bool kCounted>
Triangulation insert_all_points(PointView<double> points, const Options& options) {
  DagRun<D> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<D> triangulation = run.triangulation();
  PointSupply supply = run.supply();
  Team team;
  Blocking blocking(run.parts());
  std::mutex finishing;
  const auto work = [&](std::size_t thread) {
    NodeLocks<D, kCounted> access(triangulation.dag, team, blocking,
                                  static_cast<std::uint32_t>(thread),
                                  options.deadlocks == "priorities");
    LeafSearch<D> search(triangulation, options.location);
    InsertionPhases phases(options);
    std::vector<NodeNumber> suspects;
    supply.for_each(thread, [&](VertexNumber vertex) {
      team.check();
      phases.next_point();
      if (run.is_first(vertex)) return;
      const auto& q = run.point(vertex);
      NodeNumber node = search.find(q);
      while (!insert(run, triangulation, node, vertex, access, suspects, phases)) {
        access.rollback();
        suspects.clear();
        node = search.find_below(node, q);
      }
      access.commit();
    });
    const std::lock_guard alone(finishing);
    phases.finish();
    if (kCounted) add(options.statistics->synchronization, access.counts());
  };
  team.run(run.parts(), work);
  return run.finish();
}

}  // namespace

Triangulation insert_optimistically(PointView<double> points, const Options& options) {
  const auto insert = [&]<int D>() {
    return options.statistics != nullptr ? insert_all_points<D, true>(points, options)
                                         : insert_all_points<D, false>(points, options);
  };
  return options.dim == 2 ? insert.template operator()<2>() : insert.template operator()<3>();
}

}  // namespace delray::delaunay::internal
