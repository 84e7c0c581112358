// .node and .ele of any dimension: what is written reads back, what is broken is told with its
// line.
#include "delaunay/dimensions.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

TEST(DimensionFiles, ReadBackAsWritten) {
  const tests::TemporaryFolder folder;
  std::mt19937_64 random(1);
  for (int dim = 2; dim <= kMostDimensions; ++dim) {
    PointTable points{dim, {}};
    for (int i = 0; i < 15 * dim; ++i) {
      points.coordinates.push_back(std::normal_distribution<>()(random));
    }
    const Triangulation mesh = triangulate_dimensions(points.view(), dim);
    write_table_mesh(folder / "m.ele", points, mesh);
    const TableMesh back = read_table_mesh(folder / "m.node");
    EXPECT_EQ(back.points.dim, dim);
    EXPECT_EQ(back.points.coordinates, points.coordinates);
    EXPECT_EQ(back.triangulation.vertices, mesh.vertices);
    EXPECT_EQ(back.triangulation.dim, dim);
    EXPECT_EQ(read_point_table(folder / "m.node").coordinates, points.coordinates);
  }
}

TEST(DimensionFiles, BeginWithOneToo) {
  const tests::TemporaryFolder folder;
  folder.write("m.node",
               "# points\n5 4 1 1\n1 0 0 0 0 9 1\n2 1 0 0 0 9 1\n3 0 1 0 0 9 1\n"
               "4 0 0 1 0 9 1\n5 0 0 0 1 9 1\n");
  folder.write("m.ele", "1 5 0\n1 1 2 3 4 5\n");
  const TableMesh mesh = read_table_mesh(folder / "m.ele");
  EXPECT_EQ(mesh.triangulation.vertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(mesh.points.coordinates[19], 1);
  EXPECT_TRUE(verify_dimensions(mesh.points.view(), 4, mesh.triangulation.vertices).canonical);
}

TEST(DimensionFiles, ThatAreBrokenNameTheLine) {
  const tests::TemporaryFolder folder;
  const std::string good = "2 4 0 0\n0 1 2 3 4\n1 1 2 3 5\n", one = "1 5 0\n0 0 1 0 1 1\n";
  const struct {
    std::string node, ele, place;
  } cases[] = {
      {"2 7 0 0\n0 1 2 3 4 5 6 7\n1 1 2 3 4 5 6 7\n", one, ""},
      {"2 1 0 0\n0 1\n1 1\n", one, ""},
      {"3 4 0 0\n0 1 2 3 4\n1 1 2 3 4\n", one, "line 1"},
      {"2 4 0 0\n0 1 2 3\n1 1 2 3 4\n", one, "line 2"},
      {"2 4 0 0\n0 1 2 3 4\n1 1 2 x 4\n", one, "line 3"},
      {"2 4 0 0\n0 1 2 3 4\n1 1 2 nan 4\n", one, "line 3"},
      {"2 4 0 0\n0 1 2 3 4\n3 1 2 3 4\n", one, "line 3"},
      {"2 4 0 0\n2 1 2 3 4\n3 1 2 3 4\n", one, "line 2"},
      {"-2 4 0 0\n", one, "line 1"},
      {"", one, ""},
      {good, "1 4 0\n0 0 1 0 1\n", ""},
      {good, "1 5 0\n0 0 1 0 1 2\n", "line 2"},
      {good, "1 5 0\n0 0 1 0 1 -1\n", "line 2"},
      {good, "1 5 0\n0 0 1 0 1\n", "line 2"},
      {good, "2 5 0\n0 0 1 0 1 1\n", "line 1"},
  };
  for (const auto& each : cases) {
    folder.write("m.node", each.node);
    folder.write("m.ele", each.ele);
    try {
      read_table_mesh(folder / "m.node");
      ADD_FAILURE() << each.node << each.ele;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_EQ(error.place(), each.place) << error.what();
    }
  }
  EXPECT_THROW(read_table_mesh(folder / "none.node"), files::FileError);
}

}  // namespace
}  // namespace delray::delaunay
