// The methods whose threads share a history, in every legal combination.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

std::vector<Options> combinations() {
  const auto or_none = [](const std::vector<std::string_view>& names) {
    return names.empty() ? std::vector<std::string_view>{"none"} : names;
  };
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.locations, "dag") == method.locations.end()) continue;
    Options options;
    options.method = method.name;
    options.location = "dag";
    for (const auto split : or_none(method.splits)) {
      options.split = split;
      for (const auto order : or_none(orders_for(method, "dag"))) {
        options.order = order;
        for (const auto strategy : or_none(method.deadlocks)) {
          options.deadlocks = strategy;
          result.push_back(options);
        }
      }
    }
  }
  return result;
}

std::string name_of(const Options& options) {
  return options.method + ", " + options.split + ", " + options.order + ", " + options.deadlocks +
         ", " + std::to_string(options.threads) + " threads";
}

TEST(DagMethods, EveryCombinationGivesTheSameSimplices) {
  std::uint64_t seed = 0;
  for (const HardPoints& kind : hard_points()) {
    for (const std::size_t n : {60}) {
      const Points points = kind.make(n, ++seed);
      const Triangulation expected = triangulate(view(points));
      for (Options options : combinations()) {
        for (const int threads : {1, 2, 3, 8}) {
          options.threads = threads;
          options.seed = seed;
          const Triangulation actual = triangulate(view(points), options);
          ASSERT_EQ(hash(actual), hash(expected))
              << name_of(options) << ", " << kind.name << ", n " << n << ", seed " << seed;
          ASSERT_EQ(actual.distinct, expected.distinct) << name_of(options) << ", " << kind.name;
          ASSERT_EQ(actual.hull_facets, expected.hull_facets)
              << name_of(options) << ", " << kind.name;
        }
      }
    }
  }
}

TEST(DagMethods, CountNodesAndFragmentsWhenAsked) {
  const Points points = hard_points().front().make(2000, 3);
  for (Options options : combinations()) {
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
