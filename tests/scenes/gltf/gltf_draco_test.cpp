#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "files/error.h"
#include "files/memory_budget.h"
#include "scenes/files/load_content.h"
#include "scenes/gltf/gltf_document.h"
#include "tests/scenes/sample_files.h"

namespace delray::scenes {
namespace {

// The triangles of sample_gltf as Draco's own encoder writes them: positions (attribute 7) of 10
// bits, colours (2) of 8 bits normalised, texture coordinates (4) of 10 bits; by edgebreaker.
const char* const kEncoded =
    "RFJBQ08CAgEBAAAABwMCAwAAAv8A/wEi/wER/wERA/8AAAAAAAEAAAEACQMABwIBAgIEAAIBAQMJAgAE"
    "AgEBAQADA5UkbRsD5gickUBMAAAAAAD/AwAAAAAAAAAAAAAAAAAAAACAPwoBAQEBAmndJgEQlQT/j0kC"
    "SQIIExGKpk5zyYIAAAAA/wAAAAEBAQALA5UkJQkbSRIE6mOBgPX/////swAAAAAA/wMAAAAAAAAAAAAA"
    "AACAPwo=";
constexpr std::size_t kBytes = 185;

std::string gltf(const std::string& encoded, std::size_t bytes,
                 const std::string& attributes = R"("POSITION":7,"COLOR_0":2,"TEXCOORD_0":4)") {
  return R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],
"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1,"TEXCOORD_0":2},"indices":3,"mode":5,
"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{)" +
         attributes + R"(}}}}]}],
"accessors":[{"componentType":5126,"count":5,"type":"VEC3"},
{"componentType":5121,"count":5,"type":"VEC4","normalized":true},
{"componentType":5126,"count":5,"type":"VEC2"},{"componentType":5125,"count":9,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":)" +
         std::to_string(bytes) + R"(}],"buffers":[{"byteLength":)" + std::to_string(bytes) +
         R"(,"uri":"data:;base64,)" + encoded + "\"}]}";
}

Scene read(const std::string& content) {
  std::vector<std::string> warnings;
  LoadOptions options;
  options.memory = files::MemoryBudget(files::resident_set() + (std::uint64_t{256} << 20));
  return internal::load_content("/nowhere/a.gltf", content, warnings, options);
}

TEST(GltfDraco, TrianglesAndAttributesComeBack) {
  const Scene scene = read(gltf(kEncoded, kBytes));
  const Mesh& mesh = scene.meshes.at(0);
  // Draco splits the edge that two triangles pass in one direction.
  ASSERT_EQ(mesh.positions.size(), 7U);
  ASSERT_EQ(mesh.colours.size(), 7U);
  ASSERT_EQ(mesh.uvs.size(), 7U);
  ASSERT_EQ(mesh.triangles.size(), 3U);
  double volume =
      0;  // of the tetrahedra with (0, 0, 1): the square's two triangles have 1 / 6 each
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 top(0, 0, 1);
    volume += glm::dot(mesh.positions[t.x] - top,
                       glm::cross(mesh.positions[t.y] - top, mesh.positions[t.z] - top)) /
              6;
  }
  EXPECT_NEAR(std::abs(volume), 1 / 3.0, 1e-2);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i];
    const bool is_top = p.z > 0.5F;
    EXPECT_NEAR(mesh.uvs[i].x, is_top ? 0.5 : p.x, 2e-3);
    EXPECT_NEAR(mesh.uvs[i].y, is_top ? 0.5 : p.y, 2e-3);
    EXPECT_NEAR(mesh.colours[i].a, is_top ? 0.2 : 1, 1e-6);
    if (p.x < 0.5F && p.y < 0.5F && !is_top) {
      EXPECT_EQ(mesh.colours[i], glm::vec4(1, 0, 0, 1));
    }
  }
}

TEST(GltfDraco, AttributesThatAreNotThereAreRefusedByName) {
  for (const char* attributes : {R"("POSITION":9)", R"("POSITION":4)", R"("POSITION":99999999999)",
                                 R"("POSITION":7,"TEXCOORD_0":2)", R"("POSITION":"x")"}) {
    try {
      read(gltf(kEncoded, kBytes, attributes));
      ADD_FAILURE() << attributes;
    } catch (const files::FileError& e) {
      EXPECT_NE(std::string(e.what()).find("KHR_draco_mesh_compression"), std::string::npos);
    }
  }
}

TEST(GltfDraco, AnySetOfTextureCoordinatesComesBack) {
  const std::vector<glm::vec2> expected = read(gltf(kEncoded, kBytes)).meshes.at(0).uvs;
  std::string content = gltf(kEncoded, kBytes);
  for (std::size_t at = 0; (at = content.find("TEXCOORD_0", at)) != std::string::npos; ++at)
    content[at + 9] = '1';
  const std::string primitive = R"("primitives":[{)";
  content.insert(content.find(primitive) + primitive.size(), R"("material":0,)");
  content.insert(1, R"("textures":[{}],"materials":[{
"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}},"emissiveTexture":{"index":0,
"texCoord":1,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}}],)");
  const Mesh mesh = read(content).meshes.at(0);
  EXPECT_EQ(mesh.uvs, expected);
  ASSERT_EQ(mesh.uvs2.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(mesh.uvs2[i], 2.0F * expected[i]);
}

TEST(GltfDraco, FewBytesThatClaimMuchDoNotGetTheMemory) {
  std::string bytes;
  ASSERT_TRUE(internal::decode_data_uri("data:;base64," + std::string(kEncoded), bytes));
  // After the header of 11 bytes and the kind of traversal: 7 vertices and 3 triangles.
  ASSERT_EQ(bytes.substr(12, 2), "\7\3");
  bytes.replace(12, 2, "\xFF\xFF\xFF\x7F\xFF\xFF\xFF\x7F");
  try {
    read(gltf(base64(bytes), bytes.size()));
    ADD_FAILURE() << "was read";
  } catch (const files::FileError& e) {
    EXPECT_EQ(e.cause(), files::Cause::memory) << e.what();
  }
}

TEST(GltfDraco, DamagedBytesAreReadOrRefused) {
  std::string sound;
  ASSERT_TRUE(internal::decode_data_uri("data:;base64," + std::string(kEncoded), sound));
  ASSERT_EQ(sound.size(), kBytes);
  const auto try_reading = [](const std::string& bytes) {
    try {
      const Scene scene = read(gltf(base64(bytes), bytes.size()));
      for (const glm::uvec3& t : scene.meshes.at(0).triangles)
        EXPECT_LT(std::max({t.x, t.y, t.z}), scene.meshes[0].positions.size());
    } catch (const files::FileError&) {
    }
  };
  for (std::size_t n = 0; n < sound.size(); n += 7) try_reading(sound.substr(0, n));
  std::mt19937 random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = sound;
    for (int k = 0; k <= trial % 4; ++k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    try_reading(bytes);
  }
}

}  // namespace
}  // namespace delray::scenes
