// Adjacency, hull and quality of small meshes and of random ones.
#include "delaunay/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/quality.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

TEST(Adjacency, IsMutualAndKnowsStars) {
  for (const char* kind : {"uniform", "grid", "cocircular", "duplicates"}) {
    const auto points = generate_points(kind, 400, 2, 1).positions;
    const Triangulation triangulation = triangulate(view(points)).triangulation;
    const Adjacency beside = adjacency(triangulation, points.size());
    std::size_t open = 0;
    for (std::uint32_t i = 0; i < beside.neighbours.size(); ++i) {
      const std::uint32_t next = beside.neighbours[i];
      if (next == Adjacency::kNone) {
        ++open;
        continue;
      }
      EXPECT_EQ(std::count_if(&beside.neighbours[3 * next], &beside.neighbours[3 * next] + 3,
                              [&](std::uint32_t t) { return t == i / 3; }),
                1);
    }
    EXPECT_EQ(open, triangulation.hull_facets);
    for (std::uint32_t row = 0; row < points.size(); ++row) {
      std::set<std::uint32_t> star, link;
      for (std::uint32_t i = 0; i < triangulation.vertices.size(); ++i) {
        if (triangulation.vertices[i] != row) continue;
        star.insert(i / 3);
        for (std::uint32_t k = 0; k < 3; ++k) link.insert(triangulation.vertices[i / 3 * 3 + k]);
      }
      link.erase(row);
      const auto around = simplices_around(triangulation, beside, row);
      EXPECT_EQ(around.size(), star.size());
      EXPECT_EQ(std::set(around.begin(), around.end()), star);
      const auto vertices = vertices_around(triangulation, beside, row);
      EXPECT_TRUE(std::ranges::equal(vertices, link));
    }
  }
}

TEST(Adjacency, TetrahedraOfACube) {
  // Around the diagonal from 0 to 7.
  Triangulation cube;
  cube.dim = 3;
  const std::uint32_t ring[] = {1, 3, 2, 6, 4, 5};
  for (int i = 0; i < 6; ++i) {
    for (const std::uint32_t v : {0U, 7U, ring[i], ring[(i + 1) % 6]}) cube.vertices.push_back(v);
  }
  const Adjacency beside = adjacency(cube, 8);
  EXPECT_EQ(std::ranges::count(beside.neighbours, Adjacency::kNone), 12);
  EXPECT_EQ(simplices_around(cube, beside, 0).size(), 6U);
  EXPECT_EQ(simplices_around(cube, beside, 1).size(), 2U);
  EXPECT_EQ(vertices_around(cube, beside, 1), (std::vector<std::uint32_t>{0, 3, 5, 7}));
  EXPECT_EQ(hull_vertices(cube), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Hull, IsAPolygon) {
  const std::vector<glm::dvec3> points = {{1, 1, 0}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0},
                                          {2, 2, 0}, {0, 2, 0}, {0, 0, 0}};
  EXPECT_EQ(hull_vertices(triangulate(view(points)).triangulation),
            (std::vector<std::uint32_t>{1, 3, 2, 4, 5}));
  EXPECT_TRUE(hull_vertices(Triangulation{}).empty());
}

TEST(Quality, OfKnownShapes) {
  Triangulation one;
  one.vertices = {0, 1, 2};
  std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  Quality result = quality(view(points), one);
  EXPECT_NEAR(result.min_angle, 60, 1e-9);
  EXPECT_NEAR(result.max_angle, 60, 1e-9);
  EXPECT_NEAR(result.min_radius_ratio, 1, 1e-12);
  points = {{0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}};
  result = quality(view(points), one);
  EXPECT_NEAR(result.min_angle, 45, 1e-9);
  EXPECT_NEAR(result.max_angle, 90, 1e-9);
  EXPECT_NEAR(result.mean_radius_ratio, 2 * (std::sqrt(2.0) - 1), 1e-12);
  EXPECT_EQ(result.angles[4] + result.angles[8] + result.angles[9], 3U);
  EXPECT_EQ(result.radius_ratios[8], 1U);
  one.dim = 3;
  one.vertices = {0, 1, 2, 3};
  points = {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  result = quality(view(points), one);
  EXPECT_NEAR(result.min_angle, 70.528779365509308, 1e-9);
  EXPECT_NEAR(result.max_angle, 70.528779365509308, 1e-9);
  EXPECT_NEAR(result.min_radius_ratio, 1, 1e-12);
  points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  result = quality(view(points), one);
  EXPECT_NEAR(result.max_angle, 90, 1e-9);
  EXPECT_NEAR(result.min_angle, 54.735610317245346, 1e-9);
  // In radius 1 / (3 + sqrt 3), circumradius sqrt(3) / 2.
  EXPECT_NEAR(result.mean_radius_ratio, 6 / (3 + std::sqrt(3.0)) / std::sqrt(3.0), 1e-12);
  EXPECT_EQ(quality(view(points), Triangulation{}).simplices, 0U);
}

TEST(Quality, CountsEverything) {
  const auto points = generate_points("uniform", 20000, 2, 1).positions;
  const Triangulation triangulation = triangulate(view(points)).triangulation;
  const Quality result = quality(view(points), triangulation);
  EXPECT_EQ(result.simplices, triangulation.size());
  std::size_t angles = 0, ratios = 0;
  for (const std::size_t count : result.angles) angles += count;
  for (const std::size_t count : result.radius_ratios) ratios += count;
  EXPECT_EQ(angles, 3 * triangulation.size());
  EXPECT_EQ(ratios, triangulation.size());
  EXPECT_GT(result.mean_min_angle, result.min_angle);
  EXPECT_LT(result.min_radius_ratio, result.mean_radius_ratio);
  EXPECT_LE(result.max_angle, 180);
}

}  // namespace
}  // namespace delray::delaunay
