// Textures of glTF that use different sets of coordinates, or transform them differently.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "image/io.h"
#include "scenes/load.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

const char* const kFirst = R"("POSITION":0,"TEXCOORD_0":1)";
const std::string kBoth = std::string(kFirst) + R"(,"TEXCOORD_1":2)";

const std::vector<glm::vec2> kUvs = {{0, 0}, {1, 0.5F}, {0.25F, 2}};
const std::vector<glm::vec2> kOtherUvs = {{0.2F, 1}, {0, 0.4F}, {0.6F, 0.8F}};

// A triangle for each of `attributes`, all with one material. Accessor 1 is kUvs, 2 and 3 are
// kOtherUvs of 16 and 8 bits; all textures show the same picture.
std::string gltf(const std::vector<std::string>& attributes, const std::string& material) {
  std::string bytes;
  for (const float x : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append(bytes, x);
  for (const glm::vec2& uv : kUvs) append(bytes, uv.x), append(bytes, uv.y);
  for (const double scale : {65535.0, 255.0}) {
    for (const glm::vec2& uv : kOtherUvs) {
      for (int k = 0; k < 2; ++k) {
        const double value = double{uv[k]} * scale + 0.5;
        if (scale > 255) append(bytes, static_cast<std::uint16_t>(value));
        if (scale == 255) append(bytes, static_cast<std::uint8_t>(value));
      }
      if (scale == 255) append(bytes, std::uint16_t{0});  // elements begin at multiples of four
    }
  }
  const std::vector<image::Rgba8> texels = {{255, 0, 0, 255}, {0, 255, 0, 255}};
  const std::vector<std::byte> png = image::encode_png(2, 1, texels);
  const std::string picture(reinterpret_cast<const char*>(png.data()), png.size());
  std::string primitives;
  for (const std::string& some : attributes) {
    primitives +=
        (primitives.empty() ? "" : ",") + (R"({"material":0,"attributes":{)" + some) + "}}";
  }
  return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_texture_transform"],
"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" +
         primitives + R"(]}],"materials":[)" + material + R"(],
"textures":[{"source":0},{"source":0},{"source":0}],
"images":[{"uri":"data:image/png;base64,)" +
         base64(picture) + R"("}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":3,"type":"VEC2","normalized":true},
{"bufferView":3,"componentType":5121,"count":3,"type":"VEC2","normalized":true}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":60,"byteLength":12},
{"buffer":0,"byteOffset":72,"byteLength":12,"byteStride":4}],
"buffers":[{"byteLength":84,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]}";
}

struct Loaded {
  Scene scene;
  std::vector<std::string> warnings;
};

Loaded loaded(const std::vector<std::string>& attributes, const std::string& material) {
  const tests::TemporaryFolder folder;
  Loaded result;
  result.scene = load(folder.write("a.gltf", gltf(attributes, material)), result.warnings);
  return result;
}

void expect_near(const std::vector<glm::vec2>& uvs, const std::vector<glm::vec2>& expected) {
  ASSERT_EQ(uvs.size(), expected.size());
  for (std::size_t i = 0; i < uvs.size(); ++i) {
    EXPECT_NEAR(uvs[i].x, expected[i].x, 1e-5) << i;
    EXPECT_NEAR(uvs[i].y, expected[i].y, 1e-5) << i;
  }
}

const char* const kColourSecond = R"({"pbrMetallicRoughness":{
"baseColorTexture":{"index":0,"texCoord":1},"metallicRoughnessTexture":{"index":1}}})";

TEST(GltfUvs, TexturesOfAMaterialMayUseTwoSets) {
  const std::string bytes = std::string(kFirst) + R"(,"TEXCOORD_1":3)";
  for (const std::string& attributes : {kBoth, bytes}) {
    const Loaded one = loaded({attributes}, kColourSecond);
    EXPECT_TRUE(one.warnings.empty()) << one.warnings[0];
    const Mesh& mesh = one.scene.meshes.at(0);
    expect_near(mesh.uvs, kOtherUvs);  // those of the first texture
    EXPECT_EQ(mesh.uvs2, kUvs);
    const Material& material = one.scene.materials.at(0);
    ASSERT_EQ(one.scene.textures.size(), 2U);
    EXPECT_EQ(one.scene.textures.at(material.base_colour_texture).set, 0);
    EXPECT_EQ(one.scene.textures.at(material.metallic_roughness_texture).set, 1);
  }
}

TEST(GltfUvs, WhereAllTexturesUseTheSameSetThereIsNoSecond) {
  const Loaded one = loaded({kBoth}, R"({"pbrMetallicRoughness":{
"baseColorTexture":{"index":0,"texCoord":1}},"emissiveTexture":{"index":1,"texCoord":1}})");
  expect_near(one.scene.meshes.at(0).uvs, kOtherUvs);
  EXPECT_TRUE(one.scene.meshes[0].uvs2.empty());
  ASSERT_EQ(one.scene.textures.size(), 1U);  // equal pictures used alike are one texture
  EXPECT_EQ(one.scene.textures[0].set, 0);
}

TEST(GltfUvs, ATransformBelongsToItsTextureAndMayNameTheSet) {
  const Loaded one = loaded({kBoth}, R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
"emissiveTexture":{"index":1,"texCoord":0,"extensions":{"KHR_texture_transform":
{"texCoord":1,"offset":[0.5,0.25],"scale":[2,3]}}}})");
  EXPECT_TRUE(one.warnings.empty());
  const Mesh& mesh = one.scene.meshes.at(0);
  EXPECT_EQ(mesh.uvs, kUvs);
  std::vector<glm::vec2> expected;
  for (const glm::vec2& uv : kOtherUvs)
    expected.push_back(uv * glm::vec2(2, 3) + glm::vec2(0.5F, 0.25F));
  expect_near(mesh.uvs2, expected);
  EXPECT_EQ(one.scene.textures.at(one.scene.materials.at(0).emission_texture).set, 1);
}

TEST(GltfUvs, ASetThatMeshesLackIsReplacedByTheFirstWithOneWarning) {
  const std::string normal = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},
"normalTexture":{"index":1,"texCoord":7}})";
  const Loaded one = loaded({kBoth, kFirst, R"("POSITION":0)"}, normal);
  ASSERT_EQ(one.warnings.size(), 1U);
  EXPECT_NE(one.warnings[0].find("primitives[0] has no TEXCOORD_7"), std::string::npos)
      << one.warnings[0];
  ASSERT_EQ(one.scene.meshes.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one.scene.meshes[i].uvs, kUvs);
    EXPECT_EQ(one.scene.meshes[i].uvs2, kUvs);
  }
  EXPECT_TRUE(one.scene.meshes[2].uvs.empty() && one.scene.meshes[2].uvs2.empty());
}

TEST(GltfUvs, ASecondSetIsNeverAlone) {
  const Loaded one = loaded({R"("POSITION":0,"TEXCOORD_1":2)"}, R"({"pbrMetallicRoughness":{
"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1,"texCoord":1}}})");
  EXPECT_EQ(one.warnings.size(), 1U);
  EXPECT_EQ(one.scene.meshes.at(0).uvs.size(), 3U);
  expect_near(one.scene.meshes[0].uvs2, kOtherUvs);
}

TEST(GltfUvs, AThirdKindOfCoordinatesBecomesTheFirstWithAWarning) {
  const std::string twice = R"("extensions":{"KHR_texture_transform":{"scale":[2,2]}})";
  const Loaded one = loaded({kBoth}, R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},
"metallicRoughnessTexture":{"index":1,"texCoord":1}},"emissiveTexture":{"index":2,)" +
                                         twice + "}}");
  ASSERT_EQ(one.warnings.size(), 1U);
  EXPECT_NE(one.warnings[0].find("materials[0]"), std::string::npos) << one.warnings[0];
  EXPECT_EQ(one.scene.textures.at(one.scene.materials.at(0).emission_texture).set, 0);
}

}  // namespace
}  // namespace delray::scenes
