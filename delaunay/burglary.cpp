#include "delaunay/internal/burglary.h"

#include <mutex>
#include <optional>
#include <vector>

#include "delaunay/internal/add_counts.h"
#include "delaunay/internal/burglar_locks.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/delaunay_repair.h"
#include "delaunay/internal/insert_in_leaf.h"
#include "delaunay/internal/insert_shaken.h"
#include "delaunay/internal/insertion.h"
#include "delaunay/internal/insertion_phases.h"
#include "delaunay/internal/leaf_search.h"
#include "delaunay/internal/point_supply.h"
#include "delaunay/internal/team.h"

namespace delray::delaunay::internal {
namespace {

// From the points, alone.
Triangulation rebuild(PointView<double> points, const Options& options) {
  Options alone = options;
  alone.location = "walk";
  alone.order = "brio";
  alone.threads = 1;
  alone.statistics = nullptr;
  alone.progress = nullptr;
  return insert_all(points, alone);
}

template <int D, bool kCounted>
Triangulation insert_all_points(PointView<double> points, const Options& options) {
  DagRun<D> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<D> triangulation = run.triangulation();
  PointSupply supply = insert_alone(run, triangulation);
  Team team;
  ThreadWaits waits(run.parts());
  std::mutex finishing;
  bool robbed = false;
  const auto work = [&](std::size_t thread) {
    BurglarLocks<D, kCounted> access(triangulation.dag, team, waits,
                                     static_cast<std::uint32_t>(thread), run.parts());
    LeafSearch<D> search(triangulation, options.location);
    InsertionPhases phases(options);
    std::vector<NodeNumber> suspects;
    supply.for_each(thread, [&](VertexNumber vertex) {
      team.check();
      phases.next_point();
      if (run.is_first(vertex)) return;
      const NodeNumber leaf = search.find(run.point(vertex));
      insert_shaken(run, triangulation, leaf, vertex, access, suspects, phases);
      access.commit();
    });
    const std::lock_guard alone(finishing);
    phases.finish();
    robbed |= access.has_robbed();
    if (kCounted) add(options.statistics->synchronization, access.counts());
  };
  team.run(run.parts(), work);
  // An insertion is exact beside those that keep its locks in order, and nothing can be wrong
  // without a burglary; with one, all that came after it may have built on what it left.
  std::optional<std::uint64_t> repaired = 0;
  if (robbed) repaired = repair(triangulation, run.parts());
  if (kCounted) options.statistics->synchronization.repaired += repaired.value_or(0);
  Triangulation result = run.finish();
  if (repaired) return result;
  if (kCounted) ++options.statistics->synchronization.rebuilds;
  return rebuild(points, options);
}

}  // namespace

Triangulation insert_by_burglary(PointView<double> points, const Options& options) {
  const auto insert = [&]<int D>() {
    return options.statistics != nullptr ? insert_all_points<D, true>(points, options)
                                         : insert_all_points<D, false>(points, options);
  };
  return options.dim == 2 ? insert.template operator()<2>() : insert.template operator()<3>();
}

}  // namespace delray::delaunay::internal
