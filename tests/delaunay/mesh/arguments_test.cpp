// Arguments that cannot be are std::invalid_argument, at every door of the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <vector>

#include "delaunay/adjacency.h"
#include "delaunay/dynamic.h"
#include "delaunay/generate.h"
#include "delaunay/insertion/insertion_order.h"
#include "delaunay/insertion/plan.h"
#include "delaunay/interpolate.h"
#include "delaunay/methods.h"
#include "delaunay/quality.h"
#include "delaunay/query.h"
#include "delaunay/simplify_terrain.h"
#include "delaunay/triangulate.h"
#include "delaunay/verify.h"
#include "delaunay/voronoi.h"
#include "delaunay/write_mesh.h"

namespace delray::delaunay {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

#define EXPECT_REFUSED(...) EXPECT_THROW((void)(__VA_ARGS__), std::invalid_argument)

std::vector<glm::dvec3> some_points() { return generate_points("uniform", 100, 3, 1).positions; }

TEST(Arguments, ThreadsAreFromOneToAFewThousand) {
  const auto points = some_points();
  for (const int threads : {0, -3, 100000, std::numeric_limits<int>::min()}) {
    for (const int dim : {2, 3}) {
      for (const Method& method : methods()) {
        if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
        EXPECT_REFUSED(triangulate(
            view(points), {.dim = dim, .method = std::string(method.name), .threads = threads}));
      }
    }
  }
}

TEST(Arguments, PointsHaveAsManyCoordinatesAsTheDimension) {
  const std::vector<glm::dvec2> plane(10);
  const std::vector<std::array<float, 2>> floats(10);
  EXPECT_REFUSED(triangulate(view(plane), {.dim = 3}));
  EXPECT_REFUSED(triangulate(view(floats), {.dim = 3}));
  EXPECT_REFUSED(triangulate(PointView<double>{nullptr, 10, 16}, {}));
  for (const int dim : {-1, 0, 1, 4, 1 << 30}) {
    EXPECT_REFUSED(triangulate(view(some_points()), {.dim = dim}));
    EXPECT_REFUSED(verify_simplices(dim, view(plane), {}));
    EXPECT_REFUSED(generate_points("uniform", 10, dim, 1));
    EXPECT_REFUSED(first_different_row(view(plane), view(plane), dim));
  }
  EXPECT_REFUSED(simplify_terrain(view(plane), 1));
  EXPECT_REFUSED(verify_simplices(3, view(plane), {}));
  EXPECT_REFUSED(first_different_row(view(plane), view(plane), 3));
  DynamicTriangulation<3> dynamic;
  EXPECT_REFUSED(dynamic.insert(view(plane)));
  EXPECT_TRUE(triangulate(PointView<double>{}, {.dim = 3}).triangulation.vertices.empty());
}

TEST(Arguments, NamesAreInTheirTables) {
  const auto points = some_points();
  EXPECT_REFUSED(triangulate(view(points), {.method = "nonsense"}));
  EXPECT_REFUSED(triangulate(view(points), {.location = "nonsense"}));
  EXPECT_REFUSED(triangulate(view(points), {.method = "optimistic", .split = "nonsense"}));
  EXPECT_REFUSED(triangulate(view(points), {.order = "nonsense"}));
  EXPECT_REFUSED(triangulate(view(points), {.method = "optimistic", .deadlocks = "nonsense"}));
  EXPECT_REFUSED(generate_points("nonsense", 10, 2, 1));
  EXPECT_REFUSED(insertion_order(std::span<const glm::dvec3>(points), "nonsense", 1));
  EXPECT_REFUSED(insertion_order(std::span<const glm::dvec3>(points), "brio", 1, 1.5));
  EXPECT_REFUSED(make_plan(std::span<const glm::dvec3>(points), 2, "nonsense", "brio", 1));
  EXPECT_REFUSED(make_plan(std::span<const glm::dvec3>(points), 2, "slabs", "nonsense", 1));
  EXPECT_REFUSED(make_plan(std::span<const glm::dvec3>(points), 0, "slabs", "brio", 1));
}

TEST(Arguments, QuestionsAreAboutPlacesSimplicesAndRowsThatThereAre) {
  const auto points = some_points();
  for (const int dim : {2, 3}) {
    const Triangulation triangulation = triangulate(view(points), {.dim = dim}).triangulation;
    const Query query(view(points), triangulation);
    const auto size = static_cast<std::uint32_t>(triangulation.size());
    const glm::dvec3 place(0.5);
    EXPECT_REFUSED(query.locate(place, size));
    EXPECT_REFUSED(query.locate(place, Query::kNone - 1));
    EXPECT_EQ(query.locate(place, Query::kNone), query.locate(place));
    for (const glm::dvec3& wrong : {glm::dvec3(kNan, 0, 0), glm::dvec3(0, 1 / 0.0, 0)}) {
      EXPECT_REFUSED(query.locate(wrong));
      EXPECT_REFUSED(query.nearest(wrong));
      EXPECT_REFUSED(natural_neighbours(query, wrong));
    }
    const std::vector<double> few(points.size() - 1);
    EXPECT_REFUSED(interpolate_linear(query, few, place));
    EXPECT_REFUSED(interpolate_natural_neighbour(query, few, place));
    EXPECT_REFUSED(interpolate_linear(query, {}, place));
    EXPECT_REFUSED(vertices_around(triangulation, query.adjacency(), 100));
    EXPECT_REFUSED(simplices_around(triangulation, query.adjacency(), 1000000));
    EXPECT_REFUSED(simplices_around(triangulation, {}, 0));
    EXPECT_REFUSED(voronoi(view(points), triangulation, {}));
    // Of other points than the triangulation's.
    const std::vector<glm::dvec3> fewer(points.begin(), points.begin() + 50);
    EXPECT_REFUSED(Query(view(fewer), triangulation));
    EXPECT_REFUSED(adjacency(triangulation, 50));
    EXPECT_REFUSED(quality(view(fewer), triangulation));
    EXPECT_REFUSED(voronoi(view(fewer), triangulation, query.adjacency()));
  }
}

TEST(Arguments, SimplicesAreWhole) {
  const auto points = some_points();
  Triangulation triangulation = triangulate(view(points), {.dim = 2}).triangulation;
  triangulation.vertices.pop_back();
  EXPECT_REFUSED(adjacency(triangulation, points.size()));
  EXPECT_REFUSED(quality(view(points), triangulation));
  EXPECT_REFUSED(hull_facets(triangulation));
  EXPECT_REFUSED(hull_vertices(triangulation));
  EXPECT_REFUSED(verify_simplices(2, view(points), triangulation.vertices));
  PointCloud cloud;
  cloud.positions = points;
  EXPECT_REFUSED(write_mesh("/tmp/never_written.ply", cloud, triangulation));
  triangulation = triangulate(view(points), {.dim = 2}).triangulation;
  cloud.positions.resize(50);
  EXPECT_REFUSED(write_mesh("/tmp/never_written.ply", cloud, triangulation));
  cloud.positions = points;
  cloud.intensity.resize(3);
  EXPECT_REFUSED(write_mesh("/tmp/never_written.ply", cloud, triangulation));
  EXPECT_REFUSED(select_rows(cloud, {1}));
  cloud.intensity.clear();
  EXPECT_REFUSED(select_rows(cloud, {100}));
}

}  // namespace
}  // namespace delray::delaunay
