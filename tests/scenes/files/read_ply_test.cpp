#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files/error.h"
#include "image/io.h"
#include "scenes/files/load_content.h"
#include "scenes/load.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

Mesh read_ply_text(const std::string& content) {
  std::vector<std::string> warnings;
  const Scene scene = internal::load_content("/nowhere/a.ply", content, warnings);
  for (const std::string& w : warnings) ADD_FAILURE() << "warning: " << w;
  EXPECT_EQ(scene.meshes.size(), 1U);
  return scene.meshes.at(0);
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kSixVertices = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";

std::string strips(const std::string& strip, const char* type = "int") {
  return "ply\nformat ascii 1.0\nelement vertex 6\n" + kXyz +
         "element tristrips 1\nproperty list int " + type + " vertex_indices\nend_header\n" +
         kSixVertices + strip + "\n";
}

TEST(ReadPly, EverySecondTriangleOfAStripIsTurned) {
  EXPECT_EQ(read_ply_text(strips("6 0 1 2 3 4 5")).triangles,
            (std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
}

TEST(ReadPly, MinusOneBeginsTheNextStrip) {
  const std::vector<glm::uvec3> expected = {{0, 1, 2}, {2, 1, 3}, {3, 4, 5}};
  EXPECT_EQ(read_ply_text(strips("8 0 1 2 3 -1 3 4 5")).triangles, expected);
  EXPECT_EQ(read_ply_text(strips("11 0 1 -1 0 1 2 3 -1 3 4 5")).triangles, expected);
  EXPECT_EQ(read_ply_text(strips("8 0 1 2 3 4294967295 3 4 5", "uint")).triangles, expected);
}

TEST(ReadPly, StripsJoinedByRepeatedVerticesKeepTheirSenseWithoutAWarning) {
  EXPECT_EQ(read_ply_text(strips("8 0 1 2 2 3 3 4 5")).triangles,
            (std::vector<glm::uvec3>{{0, 1, 2}, {4, 3, 5}}));
}

TEST(ReadPly, StripsOfVerticesThatAreNotThere) {
  for (const char* strip : {"3 0 1 6", "3 0 1 -2", "3 0 1 0.5", "4 0 1 2"}) {
    EXPECT_THROW(read_ply_text(strips(strip)), files::FileError) << strip;
  }
}

TEST(ReadPly, ABinaryBodyMayBeginWithTheByteOfANewline) {
  for (const bool big : {false, true}) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
      std::string ply = sample_ply_binary(big);
      const std::size_t body = ply.find("end_header\n") + 11;
      std::string header = ply.substr(0, body);
      for (std::size_t at = 0; (at = header.find('\n', at)) != std::string::npos;) {
        header.replace(at, 1, line_end);
        at += std::string(line_end).size();
      }
      ply.replace(0, body, header);
      // A number that is almost 0, in either order of the bytes.
      ply[header.size()] = '\n';
      if (big) ply.replace(header.size(), 4, std::string("\x0A\0\0\0", 4));
      const Mesh mesh = read_ply_text(ply);
      EXPECT_EQ(mesh.triangles.size(), 3U);
      EXPECT_NEAR(mesh.positions[0].x, 0, 1e-30);
      EXPECT_NE(mesh.positions[0].x, 0);
      EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
    }
  }
}

TEST(ReadPly, TheFirstLineMayEndWithABlank) {
  for (const char* first : {"ply \n", "ply\t\r\n", "ply \t \n"}) {
    EXPECT_EQ(read_ply_text(first + sample_ply_text().substr(4)).triangles.size(), 3U);
  }
}

TEST(ReadPly, NormalsColoursAndTextureCoordinatesOfAnyType) {
  const Mesh mesh = read_ply_text(
      "ply\nformat ascii 1.0\nelement vertex 3\n" + kXyz +
      "property float nx\nproperty float ny\nproperty float nz\nproperty ushort red\n"
      "property float green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\n"
      "property double t\nproperty list uchar int strange\nelement face 1\n"
      "property uchar flags\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0 2 65535 0 255 51 0.25 1 0\n1 0 0 0 0 2 0 1 0 255 0.5 0 2 7 8\n"
      "0 1 0 0 0 2 0 0 0 255 0.75 0.5 0\n9 3 0 1 2\n");
  EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.colours[0], glm::vec4(1, 0, 1, 0.2F));
  EXPECT_EQ(mesh.colours[1], glm::vec4(0, 1, 0, 1));
  EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{0.25F, 0}, {0.5F, 1}, {0.75F, 0.5F}}));
}

TEST(ReadPly, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(read_ply_text(
                "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                "element vertex 4\n" +
                kXyz + "end_header\n4 0 1 2 3\n0 0 0\n2 0 0\n0.4 0.4 0\n0 2 0\n")
                .triangles.size(),
            2U);
}

TEST(ReadPly, TextureCoordinatesOfCornersSplitVertices) {
  const tests::TemporaryFolder folder;
  const std::vector<std::byte> png = image::encode_png(1, 1, std::vector<image::Rgba8>(1));
  folder.write("a b.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment TextureFile a b.png\nelement vertex 4\n" + kXyz +
      "element face 3\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
      "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 0.5 1 0 1\n3 1 2 3 0\n";
  std::vector<std::string> warnings;
  const Scene scene = load(folder.write("a.ply", ply), warnings);
  EXPECT_TRUE(warnings.empty());
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(mesh.positions.size(), 7U);
  EXPECT_EQ(mesh.uvs[mesh.triangles[1].y], glm::vec2(0.5F, 0));
  EXPECT_EQ(mesh.positions[mesh.triangles[1].y], glm::vec3(1, 1, 0));
  EXPECT_NE(scene.materials[mesh.material].base_colour_texture, kNone);
}

TEST(ReadPly, TextHasNoMoreValuesOrRowsThanTheHeaderSays) {
  const auto complaint = [](const std::string& vertex, const std::string& face,
                            const std::string& rest) {
    try {
      read_ply_text("ply\nformat ascii 1.0\nelement vertex 3\n" + kXyz +
                    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                    vertex + "0 1 0\n1 0 0\n" + face + rest);
    } catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint("0 0 0\n", "3 0 1 2\n", "\n \n"), "");
  EXPECT_NE(complaint("0 0 0 1\n", "3 0 1 2\n", "").find("line 10: the line has too many values"),
            std::string::npos);
  EXPECT_NE(complaint("0 0 0\n", "3 0 1 2 0\n", "").find("line 13: the line has too many values"),
            std::string::npos);
  EXPECT_NE(
      complaint("0 0 0\n", "3 0 1 2\n", "\n3 0 1 2\n").find("line 15: the file has more rows"),
      std::string::npos);
}

// The size of the first row is taken for that of all: whoever has three corners would end beyond.
TEST(ReadPly, ABinaryFirstFaceMayBeShorterThanATriangle) {
  for (const int first : {0, 1, 2}) {
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + kXyz +
                      "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    for (const float p : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
      ply.append(reinterpret_cast<const char*>(&p), sizeof p);
    for (const int size : {3, first}) {
      std::string row(1, static_cast<char>(size));
      for (int k = 0; k < size; ++k) row += std::string{static_cast<char>(k), 0, 0, 0};
      ply.insert(size == 3 ? ply.size() : ply.size() - 13, row);
    }
    std::vector<std::string> warnings;  // of the first one
    const Scene scene = internal::load_content("/nowhere/a.ply", ply, warnings);
    EXPECT_EQ(scene.meshes.at(0).triangles, std::vector<glm::uvec3>{glm::uvec3(0, 1, 2)}) << first;
    EXPECT_EQ(warnings.size(), 1U) << first;
  }
}

}  // namespace
}  // namespace delray::scenes
