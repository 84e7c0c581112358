// CGAL as the oracle for 3D triangulations: same simplices on generated sets and on sets that are
// hard.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/peers/cgal3.h"
#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points_3d.h"
#include "tests/delaunay/takes_long.h"

namespace delray::delaunay {
namespace {

void expect_as_cgal_3d(const std::vector<glm::dvec3>& points, const std::string& kind,
                       const std::vector<int>& threads) {
  const Triangulation expected = bench::triangulate_with_cgal3(points);
  for (const Method& method : methods()) {
    if (std::ranges::find(method.dims, 3) == method.dims.end()) continue;
    if (takes_long(method, points.size(), kind)) continue;
    for (const int count : threads) {
      Options options;
      options.dim = 3;
      options.method = method.name;
      options.threads = count;
      const Triangulation actual = triangulate(view(points), options).triangulation;
      EXPECT_EQ(hash(actual), hash(expected)) << kind << ", " << method.name << ", " << count;
      EXPECT_EQ(actual.size(), expected.size()) << kind << ", " << method.name;
      if (expected.size() > 0) {
        EXPECT_EQ(actual.hull_facets, expected.hull_facets) << kind << ", " << method.name;
      }
      EXPECT_EQ(actual.distinct, expected.distinct) << kind << ", " << method.name;
    }
  }
}

TEST(Cgal3d, AgreesOnGeneratedPoints) {
  for (const PointGenerator& generator : point_generators()) {
    for (const std::size_t n : {100, 2000}) {
      // Lines in space have quadratically many tetrahedra.
      const bool quadratic = generator.name == "two-lines" || generator.name == "spiral";
      expect_as_cgal_3d(generator.generate(quadratic ? 100 + n / 10 : n, 3, n).positions,
                        std::string(generator.name), {1, 2});
    }
  }
}

TEST(Cgal3d, AgreesOnHardPoints) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (const std::size_t n : {10, 30, 150}) {
      for (std::uint64_t seed = 0; seed < 2; ++seed) {
        SCOPED_TRACE("n " + std::to_string(n) + ", seed " + std::to_string(seed));
        expect_as_cgal_3d(kind.make(n, seed), kind.name, {1});
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
