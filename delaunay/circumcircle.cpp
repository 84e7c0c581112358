#include "delaunay/internal/circumcircle.h"

#include <vector>

#include "delaunay/dag_location.h"
#include "delaunay/internal/add_counts.h"
#include "delaunay/internal/circle_access.h"
#include "delaunay/internal/current_points.h"
#include "delaunay/internal/dag_run.h"
#include "delaunay/internal/delaunay_repair.h"
#include "delaunay/internal/insert_in_leaf.h"
#include "delaunay/internal/insert_shaken.h"
#include "delaunay/internal/insertion_team.h"

namespace delray::delaunay::internal {
namespace {

template <bool kCounted>
Triangulation insert_all_points(PointView<double> points, const Options& options) {
  DagRun<2> run(points, options, static_cast<std::size_t>(options.threads));
  if (run.is_flat()) return run.finish();
  const DagTriangulation<2> triangulation = run.triangulation();
  PointSupply supply = insert_alone(run, triangulation);
  CurrentPoints current(run.parts());
  bool robbed = false;
  insert_with_team(
      run, supply,
      [&](Team& team, std::size_t thread) {
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
        insert_shaken(run, triangulation, leaf, vertex, access, suspects, phases);
        access.commit();
      },
      [&](const CircleAccess<kCounted>& access) {
        robbed |= access.has_robbed();
        if (kCounted) add(options.statistics->synchronization, access.counts());
      });
  // As in the burglary method.
  const std::uint64_t repaired = robbed ? repair(triangulation, run.parts()) : 0;
  if (kCounted) options.statistics->synchronization.repaired += repaired;
  return run.finish();
}

}  // namespace

Triangulation insert_by_circles(PointView<double> points, const Options& options) {
  return options.statistics != nullptr ? insert_all_points<true>(points, options)
                                       : insert_all_points<false>(points, options);
}

}  // namespace delray::delaunay::internal
