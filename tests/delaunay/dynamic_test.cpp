#include "delaunay/dynamic.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

// The triangulation of the live rows from the start.
Triangulation expected_of(const std::vector<glm::dvec2>& points, const DynamicTriangulation& all) {
  std::vector<glm::dvec2> live;
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    if (!all.is_live(row)) continue;
    live.push_back(points[row]);
    rows.push_back(row);
  }
  Triangulation result = triangulate(view(live));
  for (std::uint32_t& vertex : result.vertices) vertex = rows[vertex];
  return result;
}

void expect_same(const std::vector<glm::dvec2>& points, const DynamicTriangulation& dynamic) {
  const Triangulation expected = expected_of(points, dynamic), actual = dynamic.triangulation();
  ASSERT_EQ(actual.size(), expected.size());
  EXPECT_EQ(hash(actual), hash(expected));
  EXPECT_EQ(actual.distinct, expected.distinct);
  EXPECT_EQ(actual.hull_facets, expected.hull_facets);
}

TEST(DynamicTriangulation, IsTriangulateAfterEveryStep) {
  for (const HardPoints& kind : hard_points()) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(kind.name + ", seed " + std::to_string(seed));
      std::mt19937_64 random(seed);
      const std::vector<glm::dvec2> stock = kind.make(60, seed);
      std::vector<glm::dvec2> points;
      DynamicTriangulation dynamic;
      // Grows, then shrinks until nothing is left, then grows again.
      for (int step = 0; step < 180; ++step) {
        const bool insert = step < 60 ? random() % 4 != 0 : step > 140 || random() % 4 == 0;
        if (insert) {
          points.push_back(stock[random() % stock.size()]);
          ASSERT_EQ(dynamic.insert(points.back()), points.size() - 1);
        } else if (!points.empty()) {
          auto row = static_cast<std::uint32_t>(random() % points.size());
          while (row + 1 < points.size() && !dynamic.is_live(row)) ++row;
          const bool was_live = dynamic.is_live(row);
          ASSERT_EQ(dynamic.remove(row), was_live);
        }
        expect_same(points, dynamic);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(DynamicTriangulation, TakesBatches) {
  for (const PointGenerator& generator : point_generators()) {
    SCOPED_TRACE(generator.name);
    const auto cloud = generator.generate(2000, 2, 3);
    std::vector<glm::dvec2> points(cloud.positions.begin(), cloud.positions.end());
    const std::vector<glm::dvec2> first(points.begin(), points.begin() + 900);
    const std::vector<glm::dvec2> second(points.begin() + 900, points.end());
    DynamicTriangulation dynamic;
    EXPECT_EQ(dynamic.insert(view(first)), 0U);
    EXPECT_EQ(dynamic.insert(view(second)), 900U);
    expect_same(points, dynamic);
    for (std::uint32_t row = 0; row < points.size(); row += 3) EXPECT_TRUE(dynamic.remove(row));
    EXPECT_EQ(dynamic.size(), 2000U - 667U);
    expect_same(points, dynamic);
    EXPECT_EQ(dynamic.insert(view(first)), 2000U);
    points.insert(points.end(), first.begin(), first.end());
    expect_same(points, dynamic);
    for (std::uint32_t row = 0; row < points.size(); ++row) dynamic.remove(row);
    EXPECT_EQ(dynamic.size(), 0U);
    expect_same(points, dynamic);
  }
}

TEST(DynamicTriangulation, RemovesTheMiddleOfAFan) {
  // All are neighbours of the middle one, and cocircular.
  std::vector<glm::dvec2> points = {{0, 0}};
  for (const auto& p : generate_points("cocircular", 500, 2, 1).positions) points.emplace_back(p);
  DynamicTriangulation dynamic;
  dynamic.insert(view(points));
  EXPECT_TRUE(dynamic.remove(0));
  EXPECT_FALSE(dynamic.remove(0));
  EXPECT_FALSE(dynamic.remove(12345));
  expect_same(points, dynamic);
}

TEST(DynamicTriangulation, RefusesWhatIsNotFinite) {
  DynamicTriangulation dynamic;
  const std::vector<glm::dvec2> points = {{0, 0}, {1, std::nan("")}};
  EXPECT_THROW(dynamic.insert(view(points)), std::invalid_argument);
  EXPECT_THROW(dynamic.insert(points[1]), std::invalid_argument);
  EXPECT_EQ(dynamic.size(), 0U);
  EXPECT_EQ(dynamic.insert(points[0]), 0U);
}

}  // namespace
}  // namespace delray::delaunay
