// Meshes read back equal in every format that keeps them whole.
#include "delaunay/write_mesh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "delaunay/generate.h"
#include "delaunay/predicates.h"
#include "delaunay/read_mesh.h"
#include "delaunay/read_points.h"
#include "files/error.h"
#include "files/read_file.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

// Points that no shorter decimal than their own describes, and a fan of triangles over them.
PointCloud some_points(std::size_t n, bool has_z) {
  PointCloud cloud = generate_points("uniform", n, 3, 7);
  cloud.has_z = has_z;
  for (glm::dvec3& p : cloud.positions) {
    p = {p.x * 1e-7, p.y * 1e15, has_z ? p.z / 3 : 0};
  }
  return cloud;
}

Triangulation fan(std::uint32_t n) {
  Triangulation result;
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    for (const std::uint32_t v : {0U, i, i + 1}) result.vertices.push_back(v);
  }
  return result;
}

// Two tetrahedra on either side of the triangle 0 1 2; row 5 is unused.
PointCloud two_tetrahedra_points() {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}, {0.3, 0.3, -1}, {0, 0, 0}};
  return cloud;
}
Triangulation two_tetrahedra() { return {3, {0, 1, 2, 3, 0, 2, 1, 4}, 5, 6}; }

TEST(WriteMesh, ReadsBackEqualInEveryFormatWithIndices) {
  const tests::TemporaryFolder folder;
  for (const std::size_t n : {3, 4, 10000}) {  // several blocks of rows
    for (const bool has_z : {false, true}) {
      PointCloud cloud = some_points(n, has_z);
      cloud.colours.assign(n, glm::u8vec4(1, 2, 3, 255));
      cloud.colours.back() = {255, 0, 128, 255};
      const Triangulation triangles = fan(static_cast<std::uint32_t>(n));
      for (const char* name : {"a.ply", "a.obj", "a.off", "a.vtu", "a.node", "b.ele"}) {
        SCOPED_TRACE(name);
        write_mesh(folder / name, cloud, triangles);
        const PointMesh mesh = read_mesh(folder / name);
        EXPECT_EQ(mesh.points.positions, cloud.positions);
        EXPECT_EQ(mesh.triangulation.vertices, triangles.vertices);
        EXPECT_EQ(mesh.triangulation.dim, 2);
        EXPECT_EQ(read_points(folder / name).positions, cloud.positions);
        const std::string_view coloured_formats = "a.ply a.vtu a.obj";
        const bool coloured = coloured_formats.find(name) != std::string_view::npos;
        EXPECT_EQ(mesh.points.colours.size(), coloured ? n : 0);
        if (coloured) {
          EXPECT_EQ(mesh.points.colours, cloud.colours);
        }
      }
    }
  }
}

TEST(WriteMesh, KeepsTetrahedraWhereTheFormatCan) {
  const tests::TemporaryFolder folder;
  const PointCloud cloud = two_tetrahedra_points();
  for (const char* name : {"a.vtu", "a.ele"}) {
    write_mesh(folder / name, cloud, two_tetrahedra());
    const PointMesh mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh.points.positions, cloud.positions);
    EXPECT_EQ(mesh.triangulation.dim, 3);
    EXPECT_EQ(mesh.triangulation.vertices, two_tetrahedra().vertices);
  }
  for (const char* name : {"a.ply", "a.obj", "a.off"}) {
    write_mesh(folder / name, cloud, two_tetrahedra());
    const PointMesh mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh.points.positions, cloud.positions);
    EXPECT_EQ(mesh.triangulation.vertices, hull_facets(two_tetrahedra()));
  }
}

// The last array of the file: so many bytes after their number.
TEST(WriteMesh, VtuTellsWhoMadeWhat) {
  const tests::TemporaryFolder folder;
  const std::vector<std::uint16_t> created_by = {258, 3};
  for (const char* name : {"a.vtu", "a.ply"}) {
    write_mesh(folder / name, two_tetrahedra_points(), two_tetrahedra(), created_by);
    const std::string bytes = files::read_file(folder / name);
    const std::string tail("\4\0\0\0\0\0\0\0\2\1\3\0\n</AppendedData>", 28);
    const bool is_vtu = std::strcmp(name, "a.vtu") == 0;
    EXPECT_EQ(bytes.find("Name=\"thread\"") != std::string::npos, is_vtu);
    EXPECT_EQ(bytes.find(tail) != std::string::npos, is_vtu);
  }
  EXPECT_EQ(read_mesh(folder / "a.vtu").triangulation.vertices, two_tetrahedra().vertices);
}

TEST(WriteMesh, HullFacetsLookOutwards) {
  const PointCloud cloud = two_tetrahedra_points();
  const auto facets = hull_facets(two_tetrahedra());
  ASSERT_EQ(facets.size(), 18U);
  for (std::size_t i = 0; i < facets.size(); i += 3) {
    const auto at = [&](std::size_t k) { return cloud.positions[facets[i + k]]; };
    EXPECT_EQ(orient3d(at(0), at(1), at(2), {0.25, 0.25, 0}), -1);
  }
  // In the plane: the square's outline, counterclockwise, without the diagonal.
  EXPECT_EQ(hull_facets({2, {0, 1, 2, 0, 2, 3}, 4, 4}),
            (std::vector<std::uint32_t>{1, 2, 0, 1, 2, 3, 3, 0}));
}

TEST(WriteMesh, StlHoldsEveryTriangle) {
  const tests::TemporaryFolder folder;
  write_mesh(folder / "a.stl", two_tetrahedra_points(), two_tetrahedra());
  const std::string bytes = files::read_file(folder / "a.stl");
  ASSERT_EQ(bytes.size(), 84U + 6 * 50);
  const auto facets = hull_facets(two_tetrahedra());
  for (std::size_t i = 0; i < 6; ++i) {
    float values[12];
    std::memcpy(values, bytes.data() + 84 + i * 50, sizeof values);
    for (std::size_t k = 0; k < 9; ++k) {
      const glm::dvec3 p = two_tetrahedra_points().positions[facets[i * 3 + k / 3]];
      EXPECT_EQ(values[3 + k], static_cast<float>(p[static_cast<int>(k % 3)]));
    }
    EXPECT_NEAR(values[0] * values[0] + values[1] * values[1] + values[2] * values[2], 1, 1e-5);
  }
  EXPECT_EQ(files::identify(folder / "a.stl").format, files::Format::stl);
  EXPECT_EQ(read_mesh(folder / "a.stl").triangulation.size(), 6U);
}

TEST(WriteMesh, WritesPointsWithoutTriangles) {
  const tests::TemporaryFolder folder;
  for (const MeshWriter& writer : mesh_writers()) {
    const auto path = folder / ("a" + std::string(writer.suffixes.substr(0, 4)));
    const auto whole = path.extension() == ".nod" ? folder / "a.node" : path;
    write_mesh(whole, some_points(2, true), Triangulation{});
    if (writer.format == files::Format::stl) continue;
    const PointMesh mesh = read_mesh(whole);
    EXPECT_EQ(mesh.points.size(), 2U) << whole;
    EXPECT_EQ(mesh.triangulation.size(), 0U) << whole;
  }
}

TEST(WriteMesh, RefusesUnknownSuffixesAndNamesTheLegalOnes) {
  const tests::TemporaryFolder folder;
  for (const char* name : {"a", "a.xyz", "a.glb", "a.plyx"}) {
    try {
      write_mesh(folder / name, some_points(3, true), fan(3));
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(".vtu"), std::string::npos);
    }
  }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(WriteMesh, LeavesNothingBehindWhereItFails) {
  const tests::TemporaryFolder folder;
  // Its name is taken by a folder: the rename at the end fails.
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl", "a.vtu", "a.node"}) {
    std::filesystem::create_directories(folder / name / "inside");
    EXPECT_THROW(write_mesh(folder / name, some_points(3, true), fan(3)), files::FileError) << name;
    std::filesystem::remove_all(folder / name);
    EXPECT_EQ(folder.entries(), 0U) << name;
  }
  EXPECT_THROW(write_mesh(folder / "missing/a.ply", some_points(3, true), fan(3)),
               files::FileError);
}

}  // namespace
}  // namespace delray::delaunay
