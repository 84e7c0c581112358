// The fast method in space with several threads: the same simplices as with one.
#include "delaunay/cavity/cavity_rounds.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {
namespace {

Triangulation triangulate_with(const std::vector<glm::dvec3>& points, int threads) {
  Options options;
  options.dim = 3;
  options.method = "cavity";
  options.threads = threads;
  return triangulate(view(points), options).triangulation;
}

void expect_equal_rounds(const std::vector<glm::dvec3>& points, const std::string& name,
                         std::initializer_list<int> threads) {
  const Triangulation expected = triangulate_with(points, 1);
  for (const int count : threads) {
    const Triangulation actual = triangulate_with(points, count);
    EXPECT_EQ(hash(actual), hash(expected)) << name << ", threads " << count;
    EXPECT_EQ(actual.size(), expected.size()) << name << ", threads " << count;
    EXPECT_EQ(actual.hull_facets, expected.hull_facets) << name << ", threads " << count;
    EXPECT_EQ(actual.distinct, expected.distinct) << name << ", threads " << count;
  }
}

// Enough points for a region for each of five threads.
TEST(CavityRounds, ThreadsMakeTheSameSimplices) {
  for (const char* kind : {"uniform", "gauss", "cluster", "grid", "sphere", "duplicates", "arc",
                           "terrain", "coplanar", "ulp"}) {
    expect_equal_rounds(generate_points(kind, 12000, 3, 5).positions, kind, {2, 3, 8});
  }
}

TEST(CavityRounds, EightRegionsMakeTheSameSimplices) {
  expect_equal_rounds(generate_points("uniform", 20000, 3, 6).positions, "uniform", {8});
}

TEST(CavityRounds, PointsOfFewPlacesMakeTheSameSimplices) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    // Two lines, and others that are like them, have quadratically many tetrahedra.
    if (kind.name == "near a sphere" || kind.name == "of all sizes") continue;
    expect_equal_rounds(kind.make(6000, 1), kind.name, {2});
  }
}

// Lines in space have so many tetrahedra that the slots do not suffice, in the middle of a pass.
TEST(CavityRounds, MeshGrowsBetweenPasses) {
  std::vector<glm::dvec3> points = generate_points("uniform", 10000, 3, 7).positions;
  for (const glm::dvec3& p : generate_points("two-lines", 700, 3, 7).positions) {
    points.push_back(10.0 * p + 50.0);
  }
  const Triangulation expected = triangulate_with(points, 1);
  EXPECT_GT(expected.size(), 9 * points.size());
  expect_equal_rounds(points, "with lines", {2, 3});
}

}  // namespace
}  // namespace delray::delaunay
