// Four sphere tests at once against the exact predicates, on every instruction set.
#include "delaunay/cavity/four_spheres.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>
#include "tests/support/targets.h"

#include "delaunay/predicates/conflict.h"
#include "tests/delaunay/hard_points_3d.h"
#include "tests/support/targets.h"

namespace delray::delaunay::internal {
namespace {

struct Tally {
  int decided = 0, undecided = 0, ties = 0;
};

// Tetrahedra of random points against random other points.
Tally compare(const std::vector<glm::dvec3>& points, std::uint64_t seed) {
  Tally tally;
  std::mt19937_64 random(seed);
  const PointRange range = finite_range(view(points));
  const SphereTests tests(range);
  Array<SpaceVertex> vertices(points.size() + 1);
  vertices[0] = {glm::dvec3(0), 0, 0};
  for (std::uint32_t i = 0; i < points.size(); ++i) vertices[i + 1] = {points[i], i, 0};
  Mesh<3> mesh(4);
  const TestFourSpheres test = test_four_spheres();
  constexpr AnyPoints predicates;
  for (int turn = 0; turn < 60; ++turn) {
    const glm::dvec3& q = points[random() % points.size()];
    std::array<bool, 4> expected = {};
    SimplexNumber made = 0;
    for (int tries = 0; tries < 50 && made < 4; ++tries) {
      std::array<VertexNumber, 4> v;
      for (VertexNumber& vertex : v) vertex = static_cast<VertexNumber>(random() % points.size());
      const auto p = [&](std::size_t k) -> const glm::dvec3& { return points[v[k]]; };
      const int sign = predicates.orient3d(p(0), p(1), p(2), p(3));
      if (sign == 0 || p(0) == q || p(1) == q || p(2) == q || p(3) == q) continue;
      if (sign < 0) std::swap(v[0], v[1]);
      for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(made, k), v[k]);
      tally.ties += predicates.insphere(p(0), p(1), p(2), p(3), q) == 0 ? 1 : 0;
      expected[made++] = sphere_conflict(predicates, p(0), p(1), p(2), p(3), q);
    }
    if (made == 0) continue;
    std::array<SimplexNumber, 4> simplices;
    for (SimplexNumber i = 0; i < 4; ++i) simplices[i] = i < made ? i : 0;
    const FourConflicts answers = test(tests, vertices.data(), mesh, simplices.data(), q);
    for (unsigned i = 0; i < 4; ++i) {
      const bool undecided = (answers.undecided >> i & 1U) != 0;
      (undecided ? tally.undecided : tally.decided) += 1;
      if (undecided) continue;
      EXPECT_EQ((answers.inside >> i & 1U) != 0, expected[simplices[i]]) << "turn " << turn;
    }
  }
  return tally;
}

TEST(FourSpheres, AnswerLikeThePredicatesOnEveryInstructionSet) {
  tests::for_each_target([] {
    for (const HardPoints3d& kind : hard_points_3d()) {
      for (std::uint64_t seed = 0; seed < 2; ++seed) {
        SCOPED_TRACE(kind.name);
        const Tally tally = compare(kind.make(40, seed), seed);
        if (kind.name == "uniform" || kind.name == "lattice") {
          EXPECT_EQ(tally.undecided, 0);
        }
        if (kind.name == "lattice") {
          EXPECT_GT(tally.ties, 5);
        }
      }
    }
  });
}

}  // namespace
}  // namespace delray::delaunay::internal
