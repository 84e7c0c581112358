// Natural neighbours against areas of Voronoi cells, at the hull and on symmetric points.
#include "delaunay/interpolate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

using Points3 = std::vector<glm::dvec3>;

Triangulation triangulate_in(int dim, const Points3& points) {
  Options options;
  options.dim = dim;
  return triangulate(view(points), options).triangulation;
}

std::map<std::uint32_t, double> weights(int dim, const Points3& points, const glm::dvec3& q) {
  const Triangulation triangulation = triangulate_in(dim, points);
  std::map<std::uint32_t, double> result;
  for (const NaturalNeighbour& neighbour :
       natural_neighbours(Query(view(points), triangulation), q)) {
    EXPECT_TRUE(result.emplace(neighbour.row, neighbour.weight).second);
  }
  return result;
}

void expect_weights(const std::map<std::uint32_t, double>& actual,
                    const std::map<std::uint32_t, double>& expected) {
  for (const auto& [row, weight] : actual) {
    const auto known = expected.find(row);
    EXPECT_NEAR(weight, known == expected.end() ? 0 : known->second, 1e-12) << row;
  }
  for (const auto& [row, weight] : expected) EXPECT_TRUE(actual.contains(row)) << row;
}

// Weights are positive, sum to 1, and their centre of gravity is the place itself (Sibson 1980).
TEST(NaturalNeighbours, AverageToThePlace) {
  for (const int dim : {2, 3}) {
    for (const char* kind : {"uniform", "grid", "jitter", "cluster", "sphere", "gauss"}) {
      SCOPED_TRACE(kind + std::to_string(dim));
      const auto points = generate_points(kind, 300, dim, 3).positions;
      const Triangulation triangulation = triangulate_in(dim, points);
      const Query query(view(points), triangulation);
      std::mt19937_64 random(1);
      for (int round = 0; round < 100; ++round) {
        // Middles of several, so that none is close to a flat simplex of the hull.
        glm::dvec3 q(0);
        for (int i = 0; i <= dim; ++i) q += points[random() % points.size()] / (dim + 1.0);
        if (dim == 2) q.z = 0;
        double sum = 0;
        glm::dvec3 centre(0);
        for (const NaturalNeighbour& neighbour : natural_neighbours(query, q)) {
          EXPECT_GE(neighbour.weight, 0);
          sum += neighbour.weight;
          centre += neighbour.weight * query.position(neighbour.row);
        }
        ASSERT_NEAR(sum, 1, 1e-12);
        ASSERT_LT(glm::length(centre - q), 1e-9);
      }
      EXPECT_TRUE(natural_neighbours(query, {99, 0, 0}).empty());
      EXPECT_EQ(natural_neighbours(query, points[5]).size(), 1U);
    }
  }
}

// Straight from the definition: what is nearer to q than to all points, by what it is nearest to.
TEST(NaturalNeighbours, AreTheSharesOfTheCell) {
  for (const int dim : {2, 3}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto points = generate_points("uniform", 40, dim, seed).positions;
      const glm::dvec3 q = dim == 2 ? glm::dvec3(0.5, 0.45, 0) : glm::dvec3(0.5, 0.45, 0.52);
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<> unit(0, 1);
      std::map<std::uint32_t, double> counts;
      double inside = 0;
      for (int i = 0; i < 60000; ++i) {
        const double x = unit(random), y = unit(random);
        const glm::dvec3 p(x, y, dim == 3 ? unit(random) : 0);
        std::uint32_t nearest = 0;
        double least = 9;
        for (std::uint32_t row = 0; row < points.size(); ++row) {
          const double d = glm::length(points[row] - p);
          if (d < least) nearest = row;
          least = std::min(least, d);
        }
        if (glm::length(q - p) >= least) continue;
        ++counts[nearest];
        ++inside;
      }
      const auto actual = weights(dim, points, q);
      for (const auto& [row, weight] : actual) EXPECT_NEAR(weight, counts[row] / inside, 0.03);
      for (const auto& [row, count] : counts) EXPECT_TRUE(actual.contains(row)) << row;
    }
  }
}

Points3 cube() {
  Points3 points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  return points;
}

TEST(NaturalNeighbours, OfACube) {
  std::map<std::uint32_t, double> eighths;
  for (std::uint32_t i = 0; i < 8; ++i) eighths[i] = 0.125;
  expect_weights(weights(3, cube(), {0.5, 0.5, 0.5}), eighths);
  // On a face, on an edge, at a corner.
  expect_weights(weights(3, cube(), {0.5, 0.5, 0}), {{0, 0.25}, {1, 0.25}, {2, 0.25}, {3, 0.25}});
  expect_weights(weights(3, cube(), {1, 0.25, 1}), {{5, 0.75}, {7, 0.25}});
  expect_weights(weights(3, cube(), {1, 0, 1}), {{5, 1}});
  EXPECT_TRUE(weights(3, cube(), {1.5, 0.5, 0.5}).empty());
}

// On the hull shares are what they tend to.
TEST(NaturalNeighbours, AreContinuousAtTheHull) {
  const auto points = cube();
  for (const glm::dvec2& place : {glm::dvec2(0.25, 0.5), glm::dvec2(0.1, 0.3)}) {
    const auto on = weights(3, points, {place, 0});
    for (const auto& [row, weight] : weights(3, points, {place, 1e-7})) {
      EXPECT_NEAR(weight, on.contains(row) ? on.at(row) : 0, 1e-4) << row;
    }
  }
}

TEST(NaturalNeighbours, OfASquare) {
  const Points3 points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  expect_weights(weights(2, points, {0.5, 0.5, 7}), {{0, 0.25}, {1, 0.25}, {2, 0.25}, {3, 0.25}});
  expect_weights(weights(2, points, {0.25, 0, 0}), {{0, 0.75}, {1, 0.25}});
}

}  // namespace
}  // namespace delray::delaunay
