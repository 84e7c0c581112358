// Repair by flips in space, which succeeds or says that it cannot.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "delaunay/history/delaunay_repair.h"
#include "delaunay/history/insert_with_retry.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/methods.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {
namespace {

// Inserts all points; from vertex `first_without` on only subdivides.
void insert(internal::DagRun<3>& run, const internal::DagTriangulation<3>& triangulation,
            VertexNumber first_without) {
  internal::SoleDagAccess<3> access(triangulation.dag, 0);
  internal::InsertionPhases phases(run.options, run.statistics);
  std::vector<CornerNumber> suspects;
  for (VertexNumber vertex = 0; vertex < run.end(0); ++vertex) {
    if (run.is_first(vertex)) continue;
    const glm::dvec3& q = run.point(vertex);
    const NodeNumber leaf = descend(triangulation.dag, triangulation.orientation,
                                    root_of(triangulation.dag, triangulation.orientation, q), q);
    internal::open_leaf(run, triangulation, leaf, vertex, access, suspects, phases);
    if (vertex < first_without) internal::legalize(triangulation, access, suspects);
    suspects.clear();
  }
}

// Flips never get stuck around a single vertex. With many, they may: then repair() says so.
TEST(DelaunayRepair3d, FlipsToTheDelaunayTriangulationOrSaysThatItCannot) {
  Options options;
  options.dim = 3;
  options.method = "burglary";
  options = resolve(options);
  Options plain;
  plain.dim = 3;
  std::uint64_t seed = 0, replaced = 0, stuck = 0;
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (const std::size_t n : {5, 9, 60}) {
      for (const std::size_t without : {std::size_t{1}, n / 3, n}) {
        const auto points = kind.make(n, ++seed);
        internal::DagRun<3> run(view(points), options, 1);
        if (run.is_flat()) continue;
        const internal::DagTriangulation<3> triangulation = run.triangulation();
        insert(run, triangulation, static_cast<VertexNumber>(n - without));
        const std::optional<std::uint64_t> made = internal::repair(triangulation, 1 + seed % 3);
        replaced += made.value_or(0);
        stuck += made ? 0 : 1;
        if (made) {
          EXPECT_EQ(internal::repair(triangulation, 2), 0U) << kind.name << ", seed " << seed;
        } else {
          EXPECT_GT(without, 1U) << kind.name << ", n " << n << ", seed " << seed;
        }
        const bool same = hash(run.finish().triangulation) ==
                          hash(triangulate(view(points), plain).triangulation);
        EXPECT_EQ(same, made.has_value()) << kind.name << ", n " << n << ", seed " << seed;
      }
    }
  }
  EXPECT_GT(replaced, 1000U);
  EXPECT_GT(stuck, 0U);
}

}  // namespace
}  // namespace delray::delaunay
