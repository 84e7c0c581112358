// Every method in the plane, in every legal combination.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

// Everything that goes together in the plane.
std::vector<Options> combinations() {
  using Names = std::vector<std::string_view>;
  const auto or_none = [](const Names& names) { return names.empty() ? Names{"none"} : names; };
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, 2) == method.dims.end()) continue;
    Options options;
    options.method = method.name;
    for (const auto location : or_none(locations_for(method, 2))) {
      options.location = location;
      for (const auto split : or_none(method.splits)) {
        options.split = split;
        for (const auto order : or_none(orders_for(method, location))) {
          options.order = order;
          for (const auto strategy : or_none(method.deadlocks)) {
            options.deadlocks = strategy;
            result.push_back(options);
          }
        }
      }
    }
  }
  return result;
}

std::string name_of(const Options& options) {
  return options.method + ", " + options.location + ", " + options.split + ", " + options.order +
         ", " + options.deadlocks + ", " + std::to_string(options.threads) + " threads";
}

void expect_same(const Points& points, const Triangulation& expected, const Options& options,
                 const std::string& points_name) {
  const Triangulation actual = triangulate(view(points), options);
  const std::string name = name_of(options) + ", " + points_name + ", n " +
                           std::to_string(points.size()) + ", seed " + std::to_string(options.seed);
  ASSERT_EQ(hash(actual), hash(expected)) << name;
  ASSERT_EQ(actual.distinct, expected.distinct) << name;
  ASSERT_EQ(actual.hull_facets, expected.hull_facets) << name;
}

constexpr std::array<int, 4> kThreads = {1, 2, 3, 8};

void expect_same_of_all(std::size_t n, std::uint64_t seed) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(n, ++seed);
    const Triangulation expected = triangulate(view(points));
    for (Options options : combinations()) {
      options.seed = seed;
      for (const int threads : kThreads) {
        options.threads = threads;
        ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind.name));
      }
    }
  }
}

TEST(DagMethods, EveryCombinationGivesTheSameSimplices) { expect_same_of_all(50, 0); }

// Every combination meets every kind and every number of threads, if not all at once.
TEST(DagMethods, EveryCombinationGivesTheSameSimplicesOfManyPoints) {
  std::uint64_t seed = 1000;
  std::size_t turn = 0;
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(500, ++seed);
    const Triangulation expected = triangulate(view(points));
    ++turn;
    for (Options options : combinations()) {
      options.seed = seed;
      options.threads = kThreads[turn++ % kThreads.size()];
      ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind.name));
    }
  }
}

TEST(DagMethods, EveryCombinationGivesTheSameSimplicesInFull) {
  if (std::getenv("DELRAY_FULL_TESTS") == nullptr) {
    GTEST_SKIP() << "set DELRAY_FULL_TESTS for all combinations on up to 2000 points";
  }
  for (const std::size_t n : {4, 20, 150, 500, 2000}) {
    ASSERT_NO_FATAL_FAILURE(expect_same_of_all(n, 2000 + n));
  }
}

TEST(DagMethods, CountNodesAndFragmentsWhenAsked) {
  const Points points = hard_points().front().make(2000, 3);
  for (Options options : combinations()) {
    if (options.location != "dag") continue;
    options.threads = 2;
    Statistics statistics;
    options.statistics = &statistics;
    const Triangulation result = triangulate(view(points), options);
    // Three nodes by the subdivision and two by each flip, of which a point has three on average
    // and at least one per node beyond the triangulation's 2 n.
    EXPECT_GT(statistics.dag_nodes, 6 * points.size()) << name_of(options);
    EXPECT_LT(statistics.dag_nodes, 12 * points.size()) << name_of(options);
    EXPECT_GE(statistics.synchronization.fragments, 1U) << name_of(options);
    EXPECT_LE(statistics.synchronization.fragments, result.size()) << name_of(options);
  }
}

}  // namespace
}  // namespace delray::delaunay
