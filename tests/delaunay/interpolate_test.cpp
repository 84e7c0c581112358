// Interpolation reproduces planes and Sibson's weights.
#include "delaunay/interpolate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

double plane(const glm::dvec3& p) { return 3 * p.x - 2 * p.y + 5 * p.z + 1; }

TEST(Interpolate, ReproducesPlanes) {
  for (const char* kind : {"uniform", "grid", "jitter", "cluster"}) {
    SCOPED_TRACE(kind);
    const auto points = generate_points(kind, 900, 2, 3).positions;
    const Triangulation triangulation = triangulate(view(points)).triangulation;
    const Query query(view(points), triangulation);
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(plane(p));
    std::mt19937_64 random(1);
    for (int round = 0; round < 300; ++round) {
      // Middles of three, so that none is close to a flat triangle of the hull.
      glm::dvec3 q(0);
      for (int i = 0; i < 3; ++i) q += points[random() % points.size()] / 3.0;
      const auto linear = interpolate_linear(query, values, q);
      const auto natural = interpolate_natural_neighbour(query, values, q);
      ASSERT_TRUE(linear && natural);
      EXPECT_NEAR(*linear, plane(q), 1e-9);
      EXPECT_NEAR(*natural, plane(q), 1e-6);
    }
    for (std::size_t row = 0; row < points.size(); row += 7) {
      EXPECT_NEAR(*interpolate_linear(query, values, points[row]), values[row], 1e-9);
      EXPECT_EQ(interpolate_natural_neighbour(query, values, points[row]), values[row]);
    }
    EXPECT_FALSE(interpolate_linear(query, values, {99, 0, 0}).has_value());
    EXPECT_FALSE(interpolate_natural_neighbour(query, values, {99, 0, 0}).has_value());
  }
}

// In the middle of a square all four corners lose the same.
TEST(Interpolate, GivesSibsonsWeights) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Triangulation triangulation = triangulate(view(points)).triangulation;
  const Query query(view(points), triangulation);
  const std::vector<double> values = {8, 4, 2, 1};
  EXPECT_NEAR(*interpolate_natural_neighbour(query, values, {0.5, 0.5, 0}), 15 / 4.0, 1e-12);
  // On an edge of the hull.
  EXPECT_NEAR(*interpolate_natural_neighbour(query, values, {0.25, 0, 0}), 7, 1e-12);
  EXPECT_NEAR(*interpolate_natural_neighbour(query, values, {1, 0.5, 0}), 3, 1e-12);
  // Symmetric about the vertical middle: equal weights left and right.
  const std::vector<double> sides = {-1, 1, 1, -1};
  EXPECT_NEAR(*interpolate_natural_neighbour(query, sides, {0.5, 0.25, 0}), 0, 1e-12);
}

TEST(Interpolate, ReproducesPlanesInSpace) {
  for (const char* kind : {"uniform", "grid", "jitter"}) {
    SCOPED_TRACE(kind);
    const auto points = generate_points(kind, 700, 3, 3).positions;
    Options options;
    options.dim = 3;
    const Triangulation triangulation = triangulate(view(points), options).triangulation;
    const Query query(view(points), triangulation);
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(plane(p));
    std::mt19937_64 random(1);
    for (int round = 0; round < 200; ++round) {
      glm::dvec3 q(0);
      for (int i = 0; i < 4; ++i) q += points[random() % points.size()] / 4.0;
      const auto linear = interpolate_linear(query, values, q);
      const auto natural = interpolate_natural_neighbour(query, values, q);
      ASSERT_TRUE(linear && natural);
      EXPECT_NEAR(*linear, plane(q), 1e-9);
      EXPECT_NEAR(*natural, plane(q), 1e-6);
    }
    EXPECT_EQ(interpolate_natural_neighbour(query, values, points[9]), values[9]);
    EXPECT_FALSE(interpolate_natural_neighbour(query, values, {9, 0, 0}).has_value());
  }
}

TEST(Interpolate, LinearInSpace) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  Triangulation one;
  one.dim = 3;
  one.vertices = {0, 1, 2, 3};
  const Query query(view(points), one);
  std::vector<double> values;
  for (const glm::dvec3& p : points) values.push_back(plane(p));
  const glm::dvec3 q(0.3, 0.5, 0.7);
  EXPECT_NEAR(*interpolate_linear(query, values, q), plane(q), 1e-12);
  EXPECT_FALSE(interpolate_linear(query, values, {2, 2, 2}).has_value());
}

}  // namespace
}  // namespace delray::delaunay
