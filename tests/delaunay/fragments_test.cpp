// Who made which simplex, and what lies together.
#include "delaunay/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "parallel/arena.h"

namespace delray::delaunay {
namespace {

Result of(const PointCloud& points, const Options& options) {
  return triangulate(view(points.positions), options);
}

// By joining simplices that have a facet in common.
std::uint64_t fragments_by_facets(const Triangulation& mesh,
                                  const std::vector<std::uint16_t>& created_by) {
  std::vector<std::size_t> root(mesh.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i];
    return i;
  };
  const auto corners = static_cast<std::size_t>(mesh.dim) + 1;
  std::map<std::vector<std::uint32_t>, std::size_t> simplex_of_facet;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t without = 0; without < corners; ++without) {
      std::vector<std::uint32_t> facet;
      for (std::size_t k = 0; k < corners; ++k)
        if (k != without) facet.push_back(mesh.vertices[corners * i + k]);
      std::sort(facet.begin(), facet.end());
      const auto [at, is_first] = simplex_of_facet.emplace(facet, i);
      if (!is_first && created_by[at->second] == created_by[i]) root[find(i)] = find(at->second);
    }
  }
  std::uint64_t fragments = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) fragments += root[i] == i ? 1 : 0;
  return fragments;
}

TEST(Fragments, AreSetsOfOneMakerJoinedByFacets) {
  for (const int dim : {2, 3}) {
    const PointCloud points = generate_points("gauss", 200, dim, 5);
    Options options;
    options.dim = dim;
    const Triangulation mesh = of(points, options).triangulation;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
      std::mt19937 random(seed);
      std::vector<std::uint16_t> created_by(mesh.size());
      // The first of many threads makes most.
      for (std::uint16_t& creator : created_by)
        creator = static_cast<std::uint16_t>(random() % (seed + 1) * (random() % 2));
      EXPECT_EQ(count_fragments(mesh, created_by, points.size()),
                fragments_by_facets(mesh, created_by))
          << dim << "D, seed " << seed;
    }
  }
  EXPECT_EQ(count_fragments({}, {}, 0), 0U);
}

TEST(CreatedBy, AreNotedForEverySimplexByEveryMethod) {
  const parallel::AllowThreads allowed(3);
  for (const int dim : {2, 3}) {
    // Enough for several tasks of divide and conquer, and for several regions of cavities.
    const PointCloud many = generate_points("cluster", dim == 2 ? 30000 : 4000, dim, 11);
    const PointCloud few = generate_points("cluster", dim == 2 ? 6000 : 800, dim, 11);
    Options options;
    options.dim = dim;
    const Hash128 of_many = hash(of(many, options).triangulation);
    const Hash128 of_few = hash(of(few, options).triangulation);
    for (const Method& method : methods()) {
      if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
      const PointCloud& points = method.slow ? few : many;
      const Hash128 expected = method.slow ? of_few : of_many;
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(std::to_string(dim) + "D " + std::string(method.name) + ", " +
                     std::to_string(threads) + " threads");
        options.method = method.name;
        options.threads = threads;
        options.created_by = true;
        options.statistics = true;
        const auto [mesh, statistics, created_by] = of(points, options);
        ASSERT_EQ(hash(mesh), expected);
        ASSERT_EQ(created_by.size(), mesh.size());
        EXPECT_LT(*std::ranges::max_element(created_by), threads);
        const std::uint64_t fragments = count_fragments(mesh, created_by, points.size());
        const std::uint64_t counted = statistics.synchronization.fragments;
        // Creators in another order than the simplices would leave few that lie together. In rounds
        // neighbours are anybody's.
        if (counted > 0) {
          EXPECT_EQ(fragments, counted);
        } else if (threads == 1) {
          EXPECT_LT(fragments, 2U);
        } else if (method.group != "rounds") {
          EXPECT_LT(fragments, mesh.size() / 20);
        }
      }
    }
  }
}

// Flips often get stuck among few points of a sphere with many threads, and one thread starts anew.
TEST(CreatedBy, AreOneThreadAfterARebuild) {
  const parallel::AllowThreads allowed(8);
  Options options;
  options.dim = 3;
  options.method = "burglary";
  options.threads = 8;
  options.created_by = true;
  options.statistics = true;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const PointCloud points = generate_points("sphere", 1000, 3, seed);
    const auto [mesh, statistics, created_by] = of(points, options);
    const Synchronization& counts = statistics.synchronization;
    EXPECT_EQ(count_fragments(mesh, created_by, points.size()), counts.fragments)
        << "seed " << seed;
    if (counts.rebuilds > 0) {
      EXPECT_EQ(counts.fragments, 1U) << "seed " << seed;
    }
  }
}

TEST(CreatedBy, AreNoneWithoutSimplices) {
  const PointCloud points = generate_points("uniform", 20000, 2, 3);
  PointCloud line = points;
  for (glm::dvec3& p : line.positions) p.y = p.x;
  for (const Method& method : methods()) {
    for (const int dim : method.dims) {
      Options options;
      options.dim = dim;
      options.method = method.name;
      options.threads = 2;
      options.created_by = true;
      const Result result = of(line, options);
      EXPECT_EQ(result.triangulation.size(), 0U);
      EXPECT_TRUE(result.created_by.empty()) << method.name;
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
