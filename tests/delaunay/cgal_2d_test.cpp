// CGAL as the oracle for 2D triangulations: same simplices on the report's six distributions and on
// sets that are hard.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/peers/cgal2.h"
#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/takes_long.h"

namespace delray::delaunay {
namespace {

void expect_as_cgal_2d(const std::vector<glm::dvec3>& points, const std::string& kind) {
  const Triangulation expected = bench::triangulate_with_cgal2(points);
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, 2) == method.dims.end()) continue;
    if (takes_long(method, points.size(), kind)) continue;
    Options options;
    options.method = method.name;
    const Triangulation actual = triangulate(view(points), options).triangulation;
    EXPECT_EQ(hash(actual), hash(expected)) << kind << ", " << method.name;
    EXPECT_EQ(actual.size(), expected.size()) << kind << ", " << method.name;
    if (expected.size() > 0) {
      EXPECT_EQ(actual.hull_facets, expected.hull_facets) << kind << ", " << method.name;
    }
    EXPECT_EQ(actual.distinct, expected.distinct) << kind << ", " << method.name;
  }
}

TEST(Cgal2d, AgreesOnGeneratedPoints) {
  for (const PointGenerator& generator : point_generators()) {
    for (const std::size_t n : {100, 200, 10000}) {
      expect_as_cgal_2d(generator.generate(n, 2, n).positions, std::string(generator.name));
    }
  }
}

TEST(Cgal2d, AgreesOnHardPoints) {
  for (const HardPoints& kind : hard_points()) {
    for (const std::size_t n : {10, 30, 300}) {
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        std::vector<glm::dvec3> points;
        for (const auto& p : kind.make(n, seed)) points.emplace_back(p, 0);
        SCOPED_TRACE("n " + std::to_string(n) + ", seed " + std::to_string(seed));
        expect_as_cgal_2d(points, kind.name);
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
