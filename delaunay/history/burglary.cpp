// The burglary method (Kohout 2004, 7.7.2): threads insert at the same time and nothing is ever
// undone.
//
// Each thread locks the simplices that it needs (burglar_locks.h); where waiting would close a
// circle of waiting threads it uses the locked simplices of the one that it would wait for. Such
// uses may leave edges or facets that are not Delaunay, which flips repair after all threads have
// ended. Expected O(n log n) in random or brio order, plus a test of every facet if there was such
// a use.
//
// Degenerate: collinear (3D: coplanar) points need no insertion. In space flips may get stuck; then
// the points are triangulated anew by one thread.
#include "delaunay/history/burglary.h"

#include <optional>
#include <vector>

#include "delaunay/history/burglar_locks.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/delaunay_repair.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/insert_with_retry.h"
#include "delaunay/history/insertion.h"
#include "delaunay/history/insertion_team.h"
#include "delaunay/history/leaf_search.h"
#include "delaunay/mesh/add_counts.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

// From the points, alone.
Triangulation rebuild(PointView<double> points, const Options& options) {
  Options alone = options;
  alone.location = "walk";
  alone.order = "brio";
  alone.threads = 1;
  alone.statistics = false;
  alone.created_by = false;
  alone.progress = nullptr;
  return insert_all(points, alone).triangulation;
}

template <int D, bool kCounted, bool kPlain>
Result insert_all_points(PointView<double> points, const Options& options) {
  DagRun<D> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<D> triangulation = run.triangulation();
  PointSupply supply = insert_alone(run, triangulation);
  Burglaries shared(run.parts(), options);
  struct Burglar {
    BurglarLocks<D, kCounted, kPlain> access;
    LeafSearch<D> search;
  };
  bool robbed = false;
  insert_with_team(
      run, supply,
      [&](parallel::Team& team, std::size_t thread) {
        return Burglar{{triangulation.dag, team, shared, static_cast<std::uint32_t>(thread)},
                       {triangulation, options.location}};
      },
      [&](Burglar& burglar, VertexNumber vertex, std::vector<NodeNumber>& suspects,
          InsertionPhases& phases) {
        const NodeNumber leaf = burglar.search.find(run.point(vertex));
        insert_with_retry(run, triangulation, leaf, vertex, burglar.access, suspects, phases);
        burglar.access.commit();
      },
      [&](const Burglar& burglar) {
        robbed |= burglar.access.has_robbed();
        if (!kCounted) return;
        add(run.statistics.synchronization, burglar.access.counts());
        add(run.statistics.flips, burglar.access.flips());
      });
  // An insertion is exact beside those that keep its locks in order, and nothing can be wrong
  // without a burglary; with one, all that came after it may have built on what it left.
  std::optional<std::uint64_t> repaired = 0;
  if (robbed) repaired = repair(triangulation, run.parts());
  if (kCounted) {
    run.statistics.synchronization.repaired += repaired.value_or(0);
    run.statistics.synchronization.mutex_bytes = shared.mutexes.bytes();
  }
  Result result = run.finish();
  if (repaired) return result;
  if (kCounted) {
    ++result.statistics.synchronization.rebuilds;
    result.statistics.synchronization.fragments = 1;  // one thread makes them all
  }
  result.triangulation = rebuild(points, options);
  result.created_by.clear();
  return result;
}

}  // namespace

Result insert_by_burglary(PointView<double> points, const Options& options) {
  return with_dimension_and_counts(options, [&]<int D, bool kCounted>() {
    return is_plain(options) ? insert_all_points<D, kCounted, true>(points, options)
                             : insert_all_points<D, kCounted, false>(points, options);
  });
}

}  // namespace delray::delaunay::internal
