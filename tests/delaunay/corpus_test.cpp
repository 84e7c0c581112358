// Replays the inputs that were kept because they broke, or might break, a reader.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "delaunay/files/parts/las_parts.h"
#include "delaunay/files/point_readers.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

struct Reader {
  const char* name;  // the folder in tests/corpus
  PointCloud (*points)(const Input&);
  PointMesh (*mesh)(const Input&);
};

PointMesh read_elements(const Input& elements) {
  return read_node_mesh({"points", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"}, elements);
}

// With segments between points that are there.
PointCloud read_poly_outline(const Input& input) {
  const Input nodes{"points", "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"};
  const Outline outline = read_outline(input, &nodes);
  for (const auto& segment : outline.segments) {
    for (const std::uint32_t row : segment) EXPECT_LT(row, outline.points.size());
  }
  return outline.points;
}

// Of an octree the nodes of a part of it.
PointCloud read_octree(const Input& input) {
  PointFilter filter;
  filter.resolution = 2;
  filter.bounds = {{-1e3, -1e3, -1e3}, {30, 30, 1e3}};
  return read_all(LasParts(ByteSource(input), filter), filter, input.memory);
}

class Corpus : public testing::TestWithParam<Reader> {};

TEST_P(Corpus, GivesFinitePointsOrAnInputError) {
  const Reader& reader = GetParam();
  const auto folder = std::filesystem::path(DELRAY_SOURCE_DIR) / "tests" / "corpus" / reader.name;
  std::size_t good = 0, bad = 0;
  const auto replay = [&](const Input& input, auto read, auto check) {
    try {
      check(read(input));
      ++good;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input) << error.what();
      EXPECT_NE(std::string(error.what()).find(input.name), std::string::npos);
      ++bad;
    }
  };
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    const std::string content = files::read_file(entry.path());
    const Input input{entry.path().string(), content};
    if (reader.points) {
      replay(input, reader.points, [](const PointCloud& cloud) {
        for (const glm::dvec3& p : cloud.positions) {
          EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        }
      });
    }
    if (reader.mesh) {
      replay(input, reader.mesh, [](const PointMesh& mesh) {
        for (const std::uint32_t vertex : mesh.triangulation.vertices) {
          EXPECT_LT(vertex, mesh.points.size());
        }
      });
    }
  }
  EXPECT_GT(good, 0U);
  EXPECT_GT(good + bad, 1U);
}

INSTANTIATE_TEST_SUITE_P(Readers, Corpus,
                         testing::Values(Reader{"read_text", &read_text_points, nullptr},
                                         Reader{"read_ply", &read_ply_points, &read_ply_mesh},
                                         Reader{"read_obj", &read_obj_points, &read_obj_mesh},
                                         Reader{"read_off", &read_off_points, &read_off_mesh},
                                         Reader{"read_las", &read_las_points, nullptr},
                                         Reader{"read_copc", &read_octree, nullptr},
                                         Reader{"read_pcd", &read_pcd_points, nullptr},
                                         Reader{"read_json", &read_json_points, nullptr},
                                         Reader{"read_node", &read_node_points, nullptr},
                                         Reader{"read_poly", &read_poly_outline, nullptr},
                                         Reader{"read_ele", nullptr, &read_elements},
                                         Reader{"read_vtu", &read_vtu_points, &read_vtu_mesh}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace delray::delaunay
