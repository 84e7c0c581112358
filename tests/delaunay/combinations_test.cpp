// Every legal combination of method, location, split, order, deadlock strategy and number of
// threads gives the same simplices.
#include "delaunay/combinations.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "tests/delaunay/same_simplices.h"
#include "tests/delaunay/takes_long.h"

namespace delray::delaunay {
namespace {

constexpr std::array<int, 4> kThreads = {1, 2, 3, 8};

TEST(Combinations, HaveNamesOfTheirOwnAndResolveToThemselves) {
  for (const int dim : {2, 3}) {
    std::set<std::string> names;
    for (const Options& options : combinations(dim)) {
      EXPECT_TRUE(names.insert(name_of(options)).second) << name_of(options);
      EXPECT_EQ(name_of(resolve(options)), name_of(options));
    }
    EXPECT_GT(names.size(), methods().size());
  }
}

TEST(Combinations, GiveTheSameSimplicesWithAnyNumberOfThreads) {
  std::uint64_t seed = 0;
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(50, ++seed);
    const Triangulation expected = expected_of(points, 2);
    for (Options options : combinations(2)) {
      options.seed = seed;
      for (const int threads : kThreads) {
        options.threads = threads;
        ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind.name));
      }
    }
  }
}

// Every combination meets every kind and every number of threads, if not all at once.
template <int D>
void expect_same_with_threads_in_turn(std::size_t n, std::uint64_t seed) {
  std::size_t turn = 0;
  for (const auto& kind : hard_points_of<D>()) {
    const auto points = kind.make(size_for(kind.name, n), ++seed);
    const Triangulation expected = expected_of(points, D);
    ++turn;
    for (Options options : combinations(D)) {
      if (takes_long(method_of(options), points.size(), kind.name)) continue;
      options.seed = seed;
      options.threads = kThreads[turn++ % kThreads.size()];
      ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind.name));
    }
  }
}

TEST(Combinations, GiveTheSameSimplicesOfManyPoints) {
  expect_same_with_threads_in_turn<2>(500, 1000);
}
TEST(Combinations, GiveTheSameSimplicesInSpace) { expect_same_with_threads_in_turn<3>(50, 0); }

// Lattices and spheres flip four to four, and put vertices on edges and facets, again and again.
TEST(Combinations, GiveTheSameSimplicesOfEveryDistributionInSpace) {
  for (const auto& generator : point_generators()) {
    const auto points = generator.generate(150, 3, 5).positions;
    const Triangulation expected = expected_of(points, 3);
    for (Options options : combinations(3)) {
      if (options.split != "none" && options.split != "random") continue;
      options.threads = options.split == "none" ? 1 : 3;
      ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, std::string(generator.name)));
    }
  }
}

// Nodes of the history per point, within bounds that follow from what an insertion does.
template <int D>
void expect_nodes(std::size_t n, std::size_t fewest, std::size_t most) {
  const auto points = hard_points_of<D>().front().make(n, 3);
  for (Options options : combinations(D)) {
    if (options.location != "dag") continue;
    options.threads = 2;
    options.statistics = true;
    const auto [result, statistics, created_by] = triangulate(view(points), options);
    EXPECT_GT(statistics.dag_nodes, fewest * points.size()) << name_of(options);
    EXPECT_LT(statistics.dag_nodes, most * points.size()) << name_of(options);
    EXPECT_GE(statistics.synchronization.fragments, 1U) << name_of(options);
    EXPECT_LE(statistics.synchronization.fragments, result.size()) << name_of(options);
    EXPECT_GT(statistics.legalize, 0) << name_of(options);
  }
}

// Three nodes by the subdivision and two by each flip, of which a point has three on average and at
// least one per node beyond the triangulation's 2 n.
TEST(Combinations, CountNodesAndFragmentsWhenAsked) { expect_nodes<2>(2000, 6, 12); }

// Four nodes by the subdivision, and a vertex has about 27 tetrahedra when it is inserted, each
// flip two to three making two more of them and three nodes.
TEST(Combinations, CountNodesAndFragmentsInSpaceWhenAsked) { expect_nodes<3>(1000, 35, 70); }

}  // namespace
}  // namespace delray::delaunay
