// Triangulations in space against the brute force from the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "delaunay/methods.h"
#include "delaunay/predicates.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/brute_force.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {
namespace {

using Tetrahedra = std::vector<std::array<std::uint32_t, 4>>;

Tetrahedra sorted(const Triangulation& triangulation) {
  Tetrahedra result(triangulation.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::copy_n(&triangulation.vertices[4 * i], 4, result[i].begin());
    std::sort(result[i].begin(), result[i].end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

// Every method in space, with one thread and with several.
std::vector<Options> combinations() {
  std::vector<Options> result;
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, 3) == method.dims.end()) continue;
    for (const int threads : {1, 2}) {
      Options options;
      options.dim = 3;
      options.method = method.name;
      options.threads = threads;
      result.push_back(options);
    }
  }
  return result;
}

std::string name_of(const Options& options) {
  return options.method + ", threads " + std::to_string(options.threads);
}

TEST(Triangulate3d, IsTheBruteForceTriangulationOfHardPoints) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 2, 3, 4, 5, 6, 8, 11};
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (const std::size_t n : kSizes) {
      for (std::uint64_t seed = 0; seed < (n < 8 ? 20U : 3U); ++seed) {
        const auto points = kind.make(n, seed);
        const Tetrahedra expected = brute_force<3>(points);
        for (const Options& options : combinations()) {
          ASSERT_EQ(sorted(triangulate(view(points), options).triangulation), expected)
              << name_of(options) << ", " << kind.name << ", n " << n << ", seed " << seed;
        }
      }
    }
  }
}

TEST(Triangulate3d, SimplicesArePositivelyOriented) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    const auto points = kind.make(50, 7);
    for (const Options& options : combinations()) {
      const Triangulation result = triangulate(view(points), options).triangulation;
      EXPECT_EQ(result.dim, 3);
      for (std::size_t i = 0; i < result.size(); ++i) {
        const std::uint32_t* v = &result.vertices[4 * i];
        ASSERT_EQ(orient3d(points[v[0]], points[v[1]], points[v[2]], points[v[3]]), 1)
            << name_of(options) << ", " << kind.name;
      }
    }
  }
}

TEST(Triangulate3d, NothingGivesNothing) {
  for (const Options& options : combinations()) {
    const Triangulation result =
        triangulate(view(std::vector<glm::dvec3>{}), options).triangulation;
    EXPECT_EQ(result.size(), 0U);
    EXPECT_EQ(result.distinct, 0U);
    EXPECT_EQ(result.dim, 3);
  }
}

TEST(Triangulate3d, NamesTheRowThatIsNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    auto points = hard_points_3d().front().make(50, 1);
    points[17].z = bad;
    points[31].x = bad;
    for (const Options& options : combinations()) {
      try {
        triangulate(view(points), options);
        ADD_FAILURE() << name_of(options);
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("row 17 "), std::string::npos) << error.what();
      }
    }
  }
}

TEST(Triangulate3d, CountsPhasesOnlyWhenAsked) {
  const auto points = hard_points_3d().front().make(1000, 2);
  for (Options options : combinations()) {
    EXPECT_EQ(triangulate(view(points), options).statistics.order, 0) << name_of(options);
    options.statistics = true;
    const Statistics statistics = triangulate(view(points), options).statistics;
    EXPECT_GT(statistics.order, 0) << name_of(options);
    EXPECT_GT(statistics.subdivide, 0) << name_of(options);
    EXPECT_GT(statistics.extract, 0) << name_of(options);
  }
}

}  // namespace
}  // namespace delray::delaunay
