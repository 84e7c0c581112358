// Triangulations that are valid and not Delaunay become so, and what is no triangulation is
// refused.
//
// A triangulation that is Delaunay for points whose axes are stretched is one of the points, and
// all hard sets have one: factors are powers of two, so that nothing is rounded.
#include "delaunay/improve.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

// Nothing where coordinates do not come back.
template <class Points>
std::optional<Triangulation> stretched(const Points& points, int dim, double factor) {
  Points others = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    others[i].y *= factor;
    if (!std::isfinite(others[i].y) || others[i].y / factor != points[i].y) return std::nullopt;
  }
  Triangulation result = expected_of(others, dim);
  result.dim = dim;
  return result;
}

// In an order of its own, some simplices turned, some vertices another of equal rows.
template <class Points>
void disguise(Triangulation& mesh, const Points& points, std::mt19937_64& random) {
  const std::size_t corners = static_cast<std::size_t>(mesh.dim) + 1;
  for (std::size_t t = mesh.size(); t-- > 1;) {
    const std::size_t other = random() % (t + 1);
    std::swap_ranges(mesh.vertices.begin() + static_cast<std::ptrdiff_t>(t * corners),
                     mesh.vertices.begin() + static_cast<std::ptrdiff_t>((t + 1) * corners),
                     mesh.vertices.begin() + static_cast<std::ptrdiff_t>(other * corners));
    if (random() % 3 == 0) std::swap(mesh.vertices[t * corners], mesh.vertices[t * corners + 1]);
  }
  for (std::uint32_t& vertex : mesh.vertices) {
    for (std::uint32_t row = 0; row < points.size() && random() % 4 == 0; ++row) {
      if (points[row] == points[vertex]) vertex = row;
    }
  }
}

TEST(Improve, MakesAnyTriangulationOfThePlaneDelaunay) {
  std::uint64_t seed = 0, flips = 0;
  for (const HardPoints& kind : hard_points()) {
    std::mt19937_64 random(++seed);
    const Points points = kind.make(120, seed);
    const Triangulation expected = expected_of(points, 2);
    for (const double factor : {0.125, 16.0}) {
      auto given = stretched(points, 2, factor);
      if (!given) continue;
      disguise(*given, points, random);
      const Improved circles = improve(view(points), *given);
      ASSERT_TRUE(circles.given.valid) << kind.name << ", seed " << seed << circles.given.reason;
      EXPECT_EQ(hash(circles.triangulation), hash(expected)) << kind.name << ", seed " << seed;
      EXPECT_EQ(circles.triangulation.hull_facets, expected.hull_facets) << kind.name;
      EXPECT_EQ(circles.triangulation.distinct, expected.distinct) << kind.name;
      EXPECT_EQ(circles.blocked, 0U);
      flips += circles.flips.sum();
      const Improved angles = improve(view(points), *given, Criterion::angle);
      const Verdict verdict = verify_triangles(view(points), angles.triangulation.vertices);
      EXPECT_TRUE(verdict.delaunay) << kind.name << ", seed " << seed << ": " << verdict.reason;
      EXPECT_EQ(improve(view(points), expected).flips.sum(), 0U) << kind.name;
      EXPECT_EQ(improve(view(points), expected, Criterion::angle).flips.sum(), 0U) << kind.name;
    }
  }
  EXPECT_GT(flips, 1000U);
}

TEST(Improve, MakesTriangulationsOfSpaceDelaunayUnlessBlocked) {
  std::uint64_t seed = 0;
  FlipCounts flips;
  int done = 0, blocked = 0;
  for (const auto& kind : hard_points_3d()) {
    std::mt19937_64 random(++seed);
    const auto points = kind.make(60, seed);
    const Triangulation expected = expected_of(points, 3);
    for (const double factor : {0.5, 4.0}) {
      auto given = stretched(points, 3, factor);
      if (!given) continue;
      disguise(*given, points, random);
      const Improved made = improve(view(points), *given);
      ASSERT_TRUE(made.given.valid) << kind.name << ", seed " << seed << ": " << made.given.reason;
      flips.two_two += made.flips.two_two;
      flips.two_three += made.flips.two_three;
      flips.three_two += made.flips.three_two;
      flips.four_four += made.flips.four_four;
      const Verdict verdict = verify_simplices(3, view(points), made.triangulation.vertices);
      EXPECT_TRUE(verdict.valid) << kind.name << ", seed " << seed << ": " << verdict.reason;
      EXPECT_EQ(verdict.canonical, made.blocked == 0) << kind.name << ", seed " << seed;
      if (made.blocked == 0) {
        EXPECT_EQ(hash(made.triangulation), hash(expected)) << kind.name << ", seed " << seed;
        EXPECT_FALSE(made.first_blocked.has_value());
        EXPECT_EQ(made.triangulation.hull_facets, expected.hull_facets) << kind.name;
      } else {
        ASSERT_TRUE(made.first_blocked.has_value());
        EXPECT_LT(*made.first_blocked, made.triangulation.size());
      }
      ++(made.blocked == 0 ? done : blocked);
    }
  }
  EXPECT_GT(done, 10);
  EXPECT_GT(flips.two_two, 0U);
  EXPECT_GT(flips.two_three, 100U);
  EXPECT_GT(flips.three_two, 100U);
  EXPECT_GT(flips.four_four, 0U);
  RecordProperty("blocked", blocked);
}

// Points on a circle: every triangulation has the same smallest angle.
TEST(Improve, AnglesLeaveWhatIsOnACircle) {
  const Points square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Triangulation given;
  given.vertices = {0, 1, 2, 0, 2, 3};
  const Improved first = improve(view(square), given, Criterion::angle);
  given.vertices = {0, 1, 3, 1, 2, 3};
  const Improved second = improve(view(square), given, Criterion::angle);
  EXPECT_EQ(first.flips.sum() + second.flips.sum(), 0U);
  EXPECT_NE(hash(first.triangulation), hash(second.triangulation));
  given.vertices = {0, 1, 2, 0, 2, 3};
  const std::uint64_t flips = improve(view(square), given).flips.sum();
  given.vertices = {0, 1, 3, 1, 2, 3};
  EXPECT_EQ(flips + improve(view(square), given).flips.sum(), 1U);
}

// A mesh with one thing changed is refused, and nothing is done.
TEST(Improve, RefusesWhatIsNoTriangulation) {
  std::mt19937_64 random(3);
  for (const int dim : {2, 3}) {
    const auto points = hard_points_3d().front().make(30, 5);
    const Triangulation good = expected_of(points, dim);
    const std::size_t corners = static_cast<std::size_t>(dim) + 1;
    const auto refuses = [&](Triangulation bad, const char* what) {
      const Improved made = improve(view(points), bad);
      EXPECT_FALSE(made.given.valid) << dim << "D " << what;
      EXPECT_FALSE(made.given.reason.empty()) << dim << "D " << what;
      EXPECT_EQ(made.triangulation.size(), 0U);
    };
    for (int i = 0; i < 20; ++i) {
      const std::size_t t = random() % good.size();
      Triangulation bad = good;
      bad.vertices.erase(bad.vertices.begin() + static_cast<std::ptrdiff_t>(t * corners),
                         bad.vertices.begin() + static_cast<std::ptrdiff_t>((t + 1) * corners));
      refuses(bad, "a simplex is missing");
      bad = good;
      bad.vertices.insert(bad.vertices.end(),
                          good.vertices.begin() + static_cast<std::ptrdiff_t>(t * corners),
                          good.vertices.begin() + static_cast<std::ptrdiff_t>((t + 1) * corners));
      refuses(bad, "a simplex is there twice");
      bad = good;
      bad.vertices[t * corners] = bad.vertices[t * corners + 1];
      refuses(bad, "a simplex is flat");
      bad = good;
      bad.vertices[t * corners] = static_cast<std::uint32_t>(points.size());
      refuses(bad, "a vertex is none of the points");
    }
    Triangulation bad = good;
    bad.vertices.clear();
    refuses(bad, "there are no simplices");
  }
}

TEST(Improve, RefusesWhatCannotBe) {
  const auto points = hard_points_3d().front().make(10, 1);
  Triangulation mesh = expected_of(points, 3);
  EXPECT_THROW(improve(view(points), mesh, Criterion::angle), std::invalid_argument);
  mesh.vertices.pop_back();
  EXPECT_THROW(improve(view(points), mesh), std::invalid_argument);
  mesh.dim = 4;
  EXPECT_THROW(improve(view(points), mesh), std::invalid_argument);
}

}  // namespace
}  // namespace delray::delaunay
