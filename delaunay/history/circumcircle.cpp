// The circum-circle method (Kohout 2004, 7.7.3): threads insert at the same time and lock no
// simplex.
//
// Each thread publishes the point that it inserts. A thread that needs a triangle waits while
// another thread's point lies in its circumcircle (circle_access.h); circles of waiting threads are
// broken as in the burglary method, and edges that this leaves wrong are flipped at the end. Each
// triangle that is touched costs a test for each other thread.
//
// Degenerate: collinear points need no insertion.
#include "delaunay/history/circumcircle.h"

#include <vector>

#include "delaunay/history/circle_access.h"
#include "delaunay/history/current_points.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/delaunay_repair.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/insert_with_retry.h"
#include "delaunay/history/insertion_team.h"
#include "delaunay/mesh/add_counts.h"
#include "parallel/team.h"

namespace delray::delaunay::internal {
namespace {

template <bool kCounted>
Result insert_all_points(PointView<double> points, const Options& options) {
  DagRun<2> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<2> triangulation = run.triangulation();
  PointSupply supply = insert_alone(run, triangulation);
  CurrentPoints current(run.parts());
  bool robbed = false;
  insert_with_team(
      run, supply,
      [&](parallel::Team& team, std::size_t thread) {
        return CircleAccess<kCounted>(triangulation, team, current,
                                      static_cast<std::uint32_t>(thread));
      },
      [&](CircleAccess<kCounted>& access, VertexNumber vertex, std::vector<NodeNumber>& suspects,
          InsertionPhases& phases) {
        const glm::dvec2& q = run.point(vertex);
        const NodeNumber leaf =
            descend(triangulation.dag, triangulation.orientation,
                    root_of(triangulation.dag, triangulation.orientation, q), q);
        // Not before, because the others wait for this point from now on.
        access.begin(vertex);
        insert_with_retry(run, triangulation, leaf, vertex, access, suspects, phases);
        access.commit();
      },
      [&](const CircleAccess<kCounted>& access) {
        robbed |= access.has_robbed();
        if (!kCounted) return;
        add(run.statistics.synchronization, access.counts());
        add(run.statistics.flips, access.flips());
      });
  // As in the burglary method.
  const std::uint64_t repaired = robbed ? repair(triangulation, run.parts()) : 0;
  if (kCounted) run.statistics.synchronization.repaired += repaired;
  return run.finish();
}

}  // namespace

Result insert_by_circles(PointView<double> points, const Options& options) {
  return options.statistics ? insert_all_points<true>(points, options)
                            : insert_all_points<false>(points, options);
}

}  // namespace delray::delaunay::internal
