// The pessimistic method (Kohout 2004, 7.6): threads locate points at the same time and insert them
// one at a time.
//
// A thread descends the shared history without a lock, enters the critical section, descends on
// from that leaf to the present one, subdivides and legalizes. options.locks says what the critical
// section is made of. Expected O(n log n) in random or
// brio order; all but the location is sequential.
//
// Degenerate: collinear (3D: coplanar) points need no insertion.
#include "delaunay/history/pessimistic.h"

#include <mutex>
#include <vector>

#include "delaunay/history/critical_section.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/insertion_team.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/mesh/add_counts.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {

namespace {

template <int D>
Result insert_all_points(PointView<double> points, const Options& options) {
  DagRun<D> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<D> triangulation = run.triangulation();
  PointSupply supply = run.supply();
  const bool by_mutex = options.locks == "mutex";
  CriticalSection leaves(by_mutex);
  std::uint64_t entered = 0, contended = 0;
  insert_with_team(
      run, supply,
      [&](parallel::Team&, std::size_t thread) {
        return SoleDagAccess<D>(triangulation.dag, static_cast<std::uint32_t>(thread));
      },
      [&](SoleDagAccess<D>& access, VertexNumber vertex, std::vector<NodeNumber>& suspects,
          InsertionPhases& phases) {
        const auto& q = run.point(vertex);
        NodeNumber leaf = descend(triangulation.dag, triangulation.orientation,
                                  root_of(triangulation.dag, triangulation.orientation, q), q);
        std::unique_lock alone(leaves, std::try_to_lock);
        const bool waits = !alone;
        if (waits) alone.lock();
        ++entered;
        contended += waits ? 1 : 0;
        leaf = descend(triangulation.dag, triangulation.orientation, leaf, q);
        phases.located();
        insert_in_leaf(run, triangulation, leaf, vertex, access, suspects, phases);
      },
      [&](const SoleDagAccess<D>& access) {
        if (options.statistics) add(run.statistics.flips, access.flips());
      });
  if (options.statistics) {
    Synchronization& counts = run.statistics.synchronization;
    counts.lock_calls = entered;
    counts.waits = contended;
    if (by_mutex) {
      counts.mutex_locks = entered;
      counts.mutex_waits = contended;
      counts.mutex_bytes = sizeof(CriticalSection);
    }
  }
  return run.finish();
}

}  // namespace

Result insert_pessimistically(PointView<double> points, const Options& options) {
  return options.dim == 2 ? insert_all_points<2>(points, options)
                          : insert_all_points<3>(points, options);
}

}  // namespace delray::delaunay::internal
