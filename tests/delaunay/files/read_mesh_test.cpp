// Mesh readers: files of other programs, bad indices, files cut off or damaged.
#include "delaunay/read_mesh.h"

#include <gtest/gtest.h>

#include <random>

#include "delaunay/write_mesh.h"
#include "files/error.h"
#include "files/read_file.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

using files::Cause;
using files::FileError;

PointMesh read(const std::string& name, const std::string& content) {
  const tests::TemporaryFolder folder;
  return read_mesh(folder.write(name, content));
}

void expect_error(const std::string& name, const std::string& content) {
  try {
    read(name, content);
    ADD_FAILURE() << "no error from " << content.substr(0, 200);
  } catch (const FileError& error) {
    EXPECT_EQ(error.cause(), Cause::input);
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
  }
}

TEST(ReadMesh, ReadsWhatOthersWrite) {
  const std::vector<std::uint32_t> expected = {0, 1, 2};
  EXPECT_EQ(read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2//2 3\n").triangulation.vertices,
            expected);
  EXPECT_EQ(
      read("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n").triangulation.vertices,
      expected);
  EXPECT_EQ(read("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "element face 1\nproperty uchar flags\nproperty list uchar int vertex_index\n"
                 "end_header\n0 0\n1 0\n0 1\n7 3 0 1 2\n")
                .triangulation.vertices,
            expected);
  const tests::TemporaryFolder folder;
  folder.write("a.node", "3 2 0 1\n1 0 0 1\n2 1 0 1\n3 0 1 1\n");
  folder.write("a.ele", "# Triangle counts from 1\n1 3 0\n1 1 2 3\n");
  EXPECT_EQ(read_mesh(folder / "a.ele").triangulation.vertices, expected);
}

TEST(ReadMesh, MakesVerticesOfTheCornersOfStl) {
  const std::string facet = "facet normal 0 0 0\nouter loop\n";
  const std::string text = "solid a b\n" + facet +
                           "vertex 0 0 0\nvertex 1e0 -0 0\nvertex +.5 1 0\nendloop\nendfacet\n" +
                           facet + "vertex 1 0 0\nvertex 2 1 1e-60\nvertex 0.5 1 0\nendloop\n";
  const PointMesh mesh = read("a.stl", text);
  EXPECT_TRUE(mesh.has_float_coordinates);
  EXPECT_EQ(mesh.points.size(), 4U);
  EXPECT_EQ(mesh.triangulation.vertices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  expect_error("a.stl", "solid a\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nendloop\n");
  expect_error("a.stl", "solid a\n" + facet + "vertex 0 0 0\n" + facet);
  expect_error("a.stl", "solid a\n" + facet + "vertex 0 0 nan\n");
  expect_error("a.stl", "solid a\n" + facet + "vertex 0 0 1e60\n");
  expect_error("a.stl",
               "solid a\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n");
}

TEST(ReadMesh, RefusesFacesThatAreNoTriangles) {
  const std::string off = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  expect_error("a.off", off + "4 0 1 2 3\n");
  expect_error("a.off", off + "2 0 1\n");
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  expect_error("a.obj", obj + "f 1 2 3 4\n");
  expect_error("a.obj", obj + "f 1 2\n");
  expect_error("a.obj", obj + "f -1 -2 -3\n");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0\n1 0\n0 1\n";
  expect_error("a.ply", ply + "4 0 1 2 1\n");
  expect_error("a.ply", ply + "-1 0 1 2 1\n");
  expect_error("a.ply", ply + "3 0 1\n");
  expect_error("a.ply", ply + "3 0 1 1.5\n");
}

TEST(ReadMesh, RefusesVerticesThatAreNotThere) {
  for (const char* bad : {"3", "-1", "4294967296", "99999999999999999999", "x"}) {
    expect_error("a.off", std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 ") + bad + "\n");
    expect_error("a.ply",
                 std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                             "property float y\nelement face 1\n"
                             "property list uchar int vertex_index\nend_header\n0 0\n1 0\n0 1\n"
                             "3 0 1 ") +
                     bad + "\n");
  }
  for (const char* bad : {"0", "4", "x", "4294967297"}) {
    expect_error("a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ") + bad + "\n");
  }
}

TEST(ReadMesh, NeedsBothFilesOfAPair) {
  const tests::TemporaryFolder folder;
  folder.write("a.node", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
  EXPECT_THROW(read_mesh(folder / "a.node"), FileError);
  folder.write("a.ele", "");
  EXPECT_THROW(read_mesh(folder / "a.node"), FileError);
  for (const char* bad : {"1 5 0\n0 0 1 2 0 1\n", "2 3 0\n0 0 1 2\n", "1 3 0\n0 0 1 3\n",
                          "9223372036854775807 3 0\n0 0 1 2\n", "-1 3 0\n0 0 1 2\n"}) {
    folder.write("a.ele", bad);
    EXPECT_THROW(read_mesh(folder / "a.node"), FileError) << bad;
  }
}

// The content of each format of a mesh of two triangles or tetrahedra.
std::vector<std::pair<std::string, std::string>> examples() {
  const tests::TemporaryFolder folder;
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25}, {1, 1, 1}};
  cloud.colours.assign(4, glm::u8vec4(1, 2, 3, 255));
  cloud.intensity.assign(4, 0.5F);
  std::vector<std::pair<std::string, std::string>> result;
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.vtu"}) {
    write_mesh(folder / name, cloud, {2, {0, 1, 2, 1, 3, 2}, 4, 4});
    result.emplace_back(name, files::read_file(folder / name));
  }
  return result;
}

TEST(ReadMesh, SurvivesFilesCutAtEveryByte) {
  const tests::TemporaryFolder folder;
  for (const auto& [name, content] : examples()) {
    for (std::size_t cut = 0; cut < content.size(); ++cut) {
      try {
        const PointMesh mesh = read_mesh(folder.write(name, content.substr(0, cut)));
        EXPECT_LE(mesh.triangulation.size(), 2U);
      } catch (const FileError& error) {
        EXPECT_EQ(error.cause(), Cause::input);
      }
    }
  }
}

TEST(ReadMesh, SurvivesRandomDamage) {
  const tests::TemporaryFolder folder;
  const auto files = examples();
  const unsigned seed = 65537;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 400; ++round) {
    auto [name, content] = files[random() % files.size()];
    for (int k = 0; k < 2; ++k) content[random() % content.size()] = static_cast<char>(random());
    try {
      const PointMesh mesh = read_mesh(folder.write(name, content));
      for (const std::uint32_t vertex : mesh.triangulation.vertices) {
        EXPECT_LT(vertex, mesh.points.size());
      }
    } catch (const FileError& error) {
      EXPECT_EQ(error.cause(), Cause::input);
    }
  }
}

TEST(ReadMesh, ReadsVtuOfOneKindOfCellOnly) {
  const tests::TemporaryFolder folder;
  const std::string good = examples().back().second;
  std::string mixed = good;
  const std::size_t types = mixed.find("\5\5");
  ASSERT_NE(types, std::string::npos);
  mixed[types] = 10;
  expect_error("a.vtu", mixed);
  for (const char* word :
       {"LittleEndian", "UInt64", "encoding=\"raw\"", "Float64", "connectivity"}) {
    std::string other = good;
    other.replace(other.find(word), 1, "X");
    expect_error("a.vtu", other);
  }
}

}  // namespace
}  // namespace delray::delaunay
