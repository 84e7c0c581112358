// Methods whose threads meet only where there are many points.
#include <gtest/gtest.h>

#include <vector>

#include "delaunay/generate.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

Statistics run_method(const char* method, const char* kind, std::size_t n, int dim, int threads) {
  const auto points = generate_points(kind, n, dim, 3).positions;
  Options options;
  options.dim = dim;
  options.method = method;
  options.threads = threads;
  options.statistics = true;
  options.created_by = true;
  const Result result = triangulate(view(points), options);
  EXPECT_EQ(hash(result.triangulation), hash(expected_of(points, dim)))
      << method << ", " << kind << ", " << dim << "D, " << threads << " threads";
  EXPECT_EQ(result.created_by.size(), result.triangulation.size());
  for (const std::uint16_t maker : result.created_by) EXPECT_LT(maker, threads);
  return result.statistics;
}

TEST(Chrisochoides, LocksRegionsThatCavitiesReachInto) {
  for (const int threads : {2, 3, 8}) {
    for (const char* kind : {"uniform", "grid", "cluster"}) {
      EXPECT_GT(run_method("chrisochoides", kind, 4000, 2, threads).synchronization.lock_calls, 0U);
    }
    EXPECT_GT(run_method("chrisochoides", "gauss", 2000, 3, threads).synchronization.lock_calls,
              0U);
  }
}

// Whom candidates lose against does not depend on threads.
TEST(Spielman, LosesAsManyCandidatesWithAnyNumberOfThreads) {
  for (const int dim : {2, 3}) {
    const auto lost = [&](int threads) {
      return run_method("spielman", "uniform", 2000, dim, threads).synchronization.rollbacks;
    };
    const std::uint64_t alone = lost(1);
    EXPECT_GT(alone, 0U);
    EXPECT_EQ(lost(2), alone);
    EXPECT_EQ(lost(8), alone);
  }
}

}  // namespace
}  // namespace delray::delaunay
