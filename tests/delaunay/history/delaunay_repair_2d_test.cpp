// Repair by flips in the plane, from triangulations that were only subdivided.
#include "delaunay/history/delaunay_repair.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "delaunay/history/insert_with_retry.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/methods.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

// Alone, and yet as careful as if others could look in between.
class CarefulAccess : public internal::SoleDagAccess<2> {
 public:
  using SoleDagAccess<2>::SoleDagAccess;
  static constexpr bool kMayRetry = true;
};

void insert_without_flips(internal::DagRun<2>& run,
                          const internal::DagTriangulation<2>& triangulation) {
  CarefulAccess access(triangulation.dag, 0);
  internal::InsertionPhases phases(run.options, run.statistics);
  std::vector<NodeNumber> suspects;
  for (VertexNumber vertex = 0; vertex < run.end(0); ++vertex) {
    if (run.is_first(vertex)) continue;
    const glm::dvec2& q = run.point(vertex);
    const NodeNumber leaf = descend(triangulation.dag, triangulation.orientation,
                                    root_of(triangulation.dag, triangulation.orientation, q), q);
    internal::open_leaf(run, triangulation, leaf, vertex, access, suspects, phases);
  }
}

Options resolved_options() {
  Options options;
  options.method = "burglary";
  return resolve(options);
}

TEST(DelaunayRepair, FlipsSubdividedTrianglesIntoTheDelaunayTriangulation) {
  std::uint64_t seed = 0, replaced = 0;
  const Options options = resolved_options();
  for (const HardPoints& kind : hard_points()) {
    for (const std::size_t n : {4, 9, 70}) {
      const Points points = kind.make(n, ++seed);
      internal::DagRun<2> run(view(points), options, 1);
      if (!run.is_flat()) {
        const internal::DagTriangulation<2> triangulation = run.triangulation();
        insert_without_flips(run, triangulation);
        replaced += internal::repair(triangulation, 1 + seed % 3);
        EXPECT_EQ(internal::repair(triangulation, 2), 0U) << kind.name << ", seed " << seed;
      }
      EXPECT_EQ(hash(run.finish().triangulation), hash(triangulate(view(points)).triangulation))
          << kind.name << ", n " << n << ", seed " << seed;
    }
  }
  EXPECT_GT(replaced, 1000U);
}

}  // namespace
}  // namespace delray::delaunay
