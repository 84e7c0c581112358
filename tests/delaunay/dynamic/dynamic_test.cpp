// Dynamic triangulations against triangulate() after every step.
#include "delaunay/dynamic.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/hard_points_3d.h"

namespace delray::delaunay {
namespace {

template <int D>
using Rows = std::vector<typename DynamicTriangulation<D>::Point>;

// The triangulation of the live rows from the start.
template <int D>
Triangulation expected_of(const Rows<D>& points, const DynamicTriangulation<D>& all) {
  Rows<D> live;
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    if (!all.is_live(row)) continue;
    live.push_back(points[row]);
    rows.push_back(row);
  }
  Options options;
  options.dim = D;
  Triangulation result = triangulate(view(live), options).triangulation;
  for (std::uint32_t& vertex : result.vertices) vertex = rows[vertex];
  return result;
}

template <int D>
void expect_same(const Rows<D>& points, const DynamicTriangulation<D>& dynamic) {
  const Triangulation expected = expected_of<D>(points, dynamic), actual = dynamic.triangulation();
  ASSERT_EQ(actual.size(), expected.size());
  EXPECT_EQ(actual.dim, D);
  EXPECT_EQ(hash(actual), hash(expected));
  EXPECT_EQ(actual.distinct, expected.distinct);
  EXPECT_EQ(actual.hull_facets, expected.hull_facets);
}

// Grows, then shrinks until nothing is left, then grows again, with points of the stock.
template <int D>
void grow_and_shrink(const Rows<D>& stock, int rise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Rows<D> points;
  DynamicTriangulation<D> dynamic;
  for (int step = 0; step < 3 * rise; ++step) {
    const bool insert = step < rise ? random() % 4 != 0 : 3 * step > 7 * rise || random() % 4 == 0;
    if (insert) {
      points.push_back(stock[random() % stock.size()]);
      ASSERT_EQ(dynamic.insert(points.back()), points.size() - 1);
    } else if (!points.empty()) {
      auto row = static_cast<std::uint32_t>(random() % points.size());
      while (row + 1 < points.size() && !dynamic.is_live(row)) ++row;
      const bool was_live = dynamic.is_live(row);
      ASSERT_EQ(dynamic.remove(row), was_live);
    }
    expect_same<D>(points, dynamic);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(DynamicTriangulation, IsTriangulateAfterEveryStep) {
  for (const HardPoints& kind : hard_points()) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(kind.name + ", seed " + std::to_string(seed));
      grow_and_shrink<2>(kind.make(60, seed), 60, seed);
    }
  }
}

TEST(DynamicTriangulation, IsTriangulateAfterEveryStepInSpace) {
  for (const HardPoints3d& kind : hard_points_3d()) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      SCOPED_TRACE(kind.name + ", seed " + std::to_string(seed));
      grow_and_shrink<3>(kind.make(40, seed), 40, seed);
    }
  }
}

template <int D>
void take_batches(std::size_t n) {
  for (const PointGenerator& generator : point_generators()) {
    SCOPED_TRACE(generator.name);
    const auto cloud = generator.generate(n, D, 3);
    Rows<D> points(cloud.positions.begin(), cloud.positions.end());
    const auto size = static_cast<std::uint32_t>(points.size()), half = size / 2;
    const Rows<D> first(points.begin(), points.begin() + half);
    const Rows<D> second(points.begin() + half, points.end());
    DynamicTriangulation<D> dynamic;
    EXPECT_EQ(dynamic.insert(view(first)), 0U);
    EXPECT_EQ(dynamic.insert(view(second)), half);
    expect_same<D>(points, dynamic);
    for (std::uint32_t row = 0; row < size; row += 3) EXPECT_TRUE(dynamic.remove(row));
    EXPECT_EQ(dynamic.size(), size - (size + 2) / 3);
    expect_same<D>(points, dynamic);
    EXPECT_EQ(dynamic.insert(view(first)), size);
    points.insert(points.end(), first.begin(), first.end());
    expect_same<D>(points, dynamic);
    for (std::uint32_t row = 0; row < points.size(); ++row) dynamic.remove(row);
    EXPECT_EQ(dynamic.size(), 0U);
    expect_same<D>(points, dynamic);
  }
}

TEST(DynamicTriangulation, TakesBatches) { take_batches<2>(2000); }
TEST(DynamicTriangulation, TakesBatchesInSpace) { take_batches<3>(200); }

TEST(DynamicTriangulation, RemovesTheMiddleOfAFan) {
  // All are neighbours of the middle one, and cocircular.
  std::vector<glm::dvec2> points = {{0, 0}};
  for (const auto& p : generate_points("cocircular", 500, 2, 1).positions) points.emplace_back(p);
  DynamicTriangulation<2> dynamic;
  dynamic.insert(view(points));
  EXPECT_TRUE(dynamic.remove(0));
  EXPECT_FALSE(dynamic.remove(0));
  EXPECT_FALSE(dynamic.remove(12345));
  expect_same<2>(points, dynamic);
}

// The middle of a sphere has all others as neighbours; its north pole may have.
TEST(DynamicTriangulation, RemovesTheMiddleOfASphere) {
  Rows<3> points = {{0, 0, 0}};
  for (const auto& p : generate_points("sphere", 300, 3, 1).positions) points.push_back(p);
  for (int i = 0; i < 60; ++i) points.emplace_back(0, 0, 0.01 * i - 0.3);
  DynamicTriangulation<3> dynamic;
  dynamic.insert(view(points));
  EXPECT_TRUE(dynamic.remove(0));
  EXPECT_FALSE(dynamic.remove(0));
  expect_same<3>(points, dynamic);
  for (std::uint32_t row = 301; row < points.size(); ++row) EXPECT_TRUE(dynamic.remove(row));
  expect_same<3>(points, dynamic);
}

TEST(DynamicTriangulation, Moves) {
  const Rows<2> points = {{0, 0}, {1, 0}, {0, 1}};
  DynamicTriangulation<2> from;
  from.insert(view(points));
  const DynamicTriangulation<2> to = std::move(from);
  expect_same<2>(points, to);
}

TEST(DynamicTriangulation, RefusesWhatIsNotFinite) {
  DynamicTriangulation<2> dynamic;
  const std::vector<glm::dvec2> points = {{0, 0}, {1, std::nan("")}};
  EXPECT_THROW(dynamic.insert(view(points)), std::invalid_argument);
  EXPECT_THROW(dynamic.insert(points[1]), std::invalid_argument);
  EXPECT_EQ(dynamic.size(), 0U);
  EXPECT_EQ(dynamic.insert(points[0]), 0U);
}

}  // namespace
}  // namespace delray::delaunay
