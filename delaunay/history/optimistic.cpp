// The optimistic method (Kohout 2004, 7.7.1): every thread locks the simplices that it needs and
// keeps them to the end of an insertion.
//
// Locks make concurrent insertions equivalent to some sequential order. A thread that must not
// wait, by the deadlock strategy, undoes its insertion from a journal (node_locks.h), locates the
// point again from where it was and retries. Expected O(n log n) in random or brio order, plus the
// insertions that are undone.
//
// Degenerate: collinear (3D: coplanar) points need no insertion. An insertion whose leaf another
// thread has subdivided meanwhile is retried.
#include "delaunay/history/optimistic.h"

#include <vector>

#include "delaunay/history/dag_run.h"
#include "delaunay/history/insertion_team.h"
#include "delaunay/history/leaf_search.h"
#include "delaunay/history/node_locks.h"
#include "delaunay/mesh/add_counts.h"
#include "parallel/team.h"

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

template <int D, bool kCounted, bool kPlain>
Result insert_all_points(PointView<double> points, const Options& options) {
  DagRun<D> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<D> triangulation = run.triangulation();
  PointSupply supply = run.supply();
  Blocking blocking(run.parts(), options);
  struct Locker {
    NodeLocks<D, kCounted, kPlain> access;
    LeafSearch<D> search;
  };
  insert_with_team(
      run, supply,
      [&](parallel::Team& team, std::size_t thread) {
        return Locker{{triangulation.dag, team, blocking, static_cast<std::uint32_t>(thread)},
                      {triangulation, options.location}};
      },
      [&](Locker& locker, VertexNumber vertex, std::vector<NodeNumber>& suspects,
          InsertionPhases& phases) {
        const auto& q = run.point(vertex);
        NodeNumber node = locker.search.find(q);
        while (!insert(run, triangulation, node, vertex, locker.access, suspects, phases)) {
          locker.access.rollback();
          suspects.clear();
          node = locker.search.find_below(node, q);
        }
        locker.access.commit();
      },
      [&](const Locker& locker) {
        if (!kCounted) return;
        add(run.statistics.synchronization, locker.access.counts());
        add(run.statistics.flips, locker.access.flips());
      });
  if (kCounted) run.statistics.synchronization.mutex_bytes = blocking.mutexes.bytes();
  return run.finish();
}

}  // namespace

Result insert_optimistically(PointView<double> points, const Options& options) {
  return with_dimension_and_counts(options, [&]<int D, bool kCounted>() {
    return is_plain(options) ? insert_all_points<D, kCounted, true>(points, options)
                             : insert_all_points<D, kCounted, false>(points, options);
  });
}

}  // namespace delray::delaunay::internal
