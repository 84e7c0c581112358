// Insertion by flips in space, in every legal combination of method, location, split, order,
// strategy and number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points3.h"

namespace delray::delaunay {
namespace {

std::vector<Options> combinations() {
  const auto or_none = [](const std::vector<std::string_view>& names) {
    return names.empty() ? std::vector<std::string_view>{"none"} : names;
  };
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, 3) == method.dims.end()) continue;
    Options options;
    options.dim = 3;
    options.method = method.name;
    for (const auto location : locations_for(method, 3)) {
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
         ", " + options.deadlocks + ", " + std::to_string(options.threads) + " threads, seed " +
         std::to_string(options.seed);
}

bool full() { return std::getenv("DELRAY_FULL_TESTS") != nullptr; }

void expect_same(const Triangulation& actual, const Triangulation& expected,
                 const std::string& name) {
  ASSERT_EQ(hash(actual), hash(expected)) << name;
  ASSERT_EQ(actual.dim, 3) << name;
  ASSERT_EQ(actual.distinct, expected.distinct) << name;
  ASSERT_EQ(actual.hull_facets, expected.hull_facets) << name;
}

// The cavity method, which is checked against the definition elsewhere, inserts without flips. Each
// kind of points meets each combination with one number of threads, or (full) with all.
TEST(DagMethods3, EveryCombinationGivesTheSameSimplices) {
  constexpr std::array<int, 4> kThreads = {1, 2, 3, 8};
  std::uint64_t seed = 0;
  for (const HardPoints3& kind : hard_points3()) {
    const auto points = kind.make(full() ? 500 : 50, ++seed);
    Options plain;
    plain.dim = 3;
    const Triangulation expected = triangulate(view(points), plain);
    std::size_t turn = seed;
    for (Options options : combinations()) {
      options.seed = seed;
      for (std::size_t i = 0; i < (full() ? kThreads.size() : 1); ++i) {
        options.threads = kThreads[turn++ % kThreads.size()];
        expect_same(triangulate(view(points), options), expected,
                    kind.name + ", " + name_of(options));
        if (HasFatalFailure()) return;
      }
      ++turn;
    }
  }
}

// Lattices and spheres flip four to four, and put vertices on edges and facets, again and again.
TEST(DagMethods3, EveryDistributionGivesTheSameSimplices) {
  for (const auto& generator : point_generators()) {
    const auto points = generator.generate(full() ? 20000 : 250, 3, 5).positions;
    Options plain;
    plain.dim = 3;
    const Triangulation expected = triangulate(view(points), plain);
    for (Options options : combinations()) {
      if (options.split != "none" && options.split != "random" && !full()) continue;
      options.threads = options.split == "none" ? 1 : 3;
      expect_same(triangulate(view(points), options), expected,
                  std::string(generator.name) + ", " + name_of(options));
      if (HasFatalFailure()) return;
    }
  }
}

TEST(DagMethods3, CountNodesAndFragmentsWhenAsked) {
  const auto points = hard_points3().front().make(1000, 3);
  for (Options options : combinations()) {
    if (options.location != "dag") continue;
    options.threads = 2;
    Statistics statistics;
    options.statistics = &statistics;
    const Triangulation result = triangulate(view(points), options);
    // Four nodes by the subdivision, and a vertex has about 27 tetrahedra when it is inserted, each
    // flip two to three making two more of them and three nodes.
    EXPECT_GT(statistics.dag_nodes, 35 * points.size()) << name_of(options);
    EXPECT_LT(statistics.dag_nodes, 70 * points.size()) << name_of(options);
    EXPECT_GE(statistics.synchronization.fragments, 1U) << name_of(options);
    EXPECT_LE(statistics.synchronization.fragments, result.size()) << name_of(options);
    EXPECT_GT(statistics.legalize, 0) << name_of(options);
  }
}

}  // namespace
}  // namespace delray::delaunay
