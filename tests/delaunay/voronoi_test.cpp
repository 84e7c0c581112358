// Voronoi diagrams are dual to their triangulations.
#include "delaunay/voronoi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

TEST(Voronoi, IsDualInThePlane) {
  for (const char* kind : {"uniform", "grid", "cluster", "duplicates"}) {
    SCOPED_TRACE(kind);
    const auto points = generate_points(kind, 500, 2, 2).positions;
    const Triangulation triangulation = triangulate(view(points)).triangulation;
    const Adjacency beside = adjacency(triangulation, points.size());
    const Voronoi diagram = voronoi(view(points), triangulation, beside);
    EXPECT_EQ(diagram.vertices.size(), triangulation.size());
    EXPECT_EQ(diagram.ray_starts.size(), triangulation.hull_facets);
    EXPECT_EQ(diagram.edges.size() + diagram.ray_starts.size(), 3 * triangulation.size());
    EXPECT_EQ(diagram.cells.size(), triangulation.vertices.size());
    for (std::size_t t = 0; t < triangulation.size(); ++t) {
      const glm::dvec3 c = diagram.vertices[t];
      const double radius = glm::length(c - points[triangulation.vertices[3 * t]]);
      for (std::size_t k = 1; k < 3; ++k) {
        const glm::dvec3& p = points[triangulation.vertices[3 * t + k]];
        EXPECT_NEAR(glm::length(c - p), radius, 1e-9 * (1 + radius * radius));
      }
    }
    for (std::uint32_t row = 0; row < points.size(); ++row) {
      const std::vector<std::uint32_t> cell(diagram.cells.begin() + diagram.cell_begin[row],
                                            diagram.cells.begin() + diagram.cell_begin[row + 1]);
      auto star = simplices_around(triangulation, beside, row);
      EXPECT_TRUE(std::ranges::is_permutation(cell, star));
      // Each is the neighbour of the one before, counterclockwise.
      for (std::size_t i = 1; i < cell.size(); ++i) {
        const auto* v = &triangulation.vertices[3 * cell[i - 1]];
        const auto k = static_cast<std::size_t>(std::find(v, v + 3, row) - v);
        EXPECT_EQ(beside.neighbours[3 * cell[i - 1] + (k + 1) % 3], cell[i]);
      }
    }
  }
}

TEST(Voronoi, RaysLeaveTheHull) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  Triangulation one;
  one.vertices = {0, 1, 2};
  Voronoi diagram = voronoi(view(points), one, adjacency(one, 3));
  EXPECT_EQ(diagram.vertices[0], glm::dvec3(1, 1, 0));
  EXPECT_TRUE(diagram.edges.empty());
  ASSERT_EQ(diagram.ray_directions.size(), 3U);
  EXPECT_EQ(diagram.ray_directions[1], glm::dvec3(-1, 0, 0));
  EXPECT_EQ(diagram.ray_directions[2], glm::dvec3(0, -1, 0));
}

TEST(Voronoi, OfTetrahedra) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}};
  Triangulation two;
  two.dim = 3;
  two.vertices = {0, 1, 2, 3, 1, 3, 2, 4};
  const Voronoi diagram = voronoi(view(points), two, adjacency(two, 5));
  EXPECT_EQ(diagram.vertices[0], glm::dvec3(1, 1, 1));
  EXPECT_EQ(diagram.edges, (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(diagram.ray_starts.size(), 6U);
  EXPECT_EQ(diagram.ray_directions[0], glm::dvec3(-1, 0, 0));
  EXPECT_EQ(diagram.cell_begin, (std::vector<std::uint32_t>{0, 1, 3, 5, 7, 8}));
  EXPECT_EQ(voronoi(view(points), Triangulation{}, adjacency(Triangulation{}, 5)).cells.size(), 0U);
}

}  // namespace
}  // namespace delray::delaunay
