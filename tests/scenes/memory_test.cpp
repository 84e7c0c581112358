// Small files that unpack to much: they cost next to nothing, or are refused before memory is
// taken.
#include <gtest/gtest.h>

#include <string>

#include "files/error.h"
#include "image/io.h"
#include "scenes/load.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

std::string primitives(int count) {
  std::string list;
  for (int i = 0; i < count; ++i) {
    list += std::string(i > 0 ? "," : "") + R"({"attributes":{"POSITION":0},"material":)" +
            std::to_string(i) + "}";
  }
  return R"("meshes":[{"primitives":[)" + list + "]}]";
}

std::string materials(int count) {
  std::string list, textures, images;
  for (int i = 0; i < count; ++i) {
    const std::string comma = i > 0 ? "," : "", number = std::to_string(i);
    list += comma + R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + number + "}}}";
    textures += comma + R"({"source":)" + number + "}";
    images += comma + R"({"uri":")" + number + ".png\"}";
  }
  return R"("materials":[)" + list + R"(],"textures":[)" + textures + R"(],"images":[)" + images +
         "]";
}

std::string gltf(const std::string& accessor, const std::string& rest) {
  return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"accessors":[{"type":"VEC3",)"
         R"("componentType":5126,)" +
         accessor +
         R"(}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,)"
         R"("uri":"data:application/octet-stream;base64,)"
         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)" +
         rest + "}";
}

files::Cause refusal(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  std::vector<std::string> warnings;
  LoadOptions options;
  options.memory = memory;
  try {
    load(path, warnings, options);
  } catch (const files::FileError& error) {
    return error.cause();
  }
  ADD_FAILURE() << path << " was read";
  return files::Cause::device;
}

std::string blank_png(int side, std::uint8_t grey) {
  const std::vector<image::Rgba8> texels(static_cast<std::size_t>(side) * side,
                                         {grey, grey, grey, 255});
  const std::vector<std::byte> png = image::encode_png(side, side, texels);
  return {reinterpret_cast<const char*>(png.data()), png.size()};
}

TEST(Memory, AccessorsWithoutDataCostNothing) {
  const tests::TemporaryFolder folder;
  const std::uint64_t before = files::resident_set();
  const files::MemoryBudget little(before + 30 * kMebibyte);
  for (const std::string accessor :
       {R"("count":16777216)", R"("count":4294967294)",
        R"("count":16777216,"sparse":{"count":1,"indices":{"bufferView":0,"componentType":5125},)"
        R"("values":{"bufferView":0}})"}) {
    const auto path = folder.write("a.gltf", gltf(accessor, primitives(1) + "," + materials(1)));
    EXPECT_EQ(refusal(path, little), files::Cause::input) << accessor;
    EXPECT_LT(files::resident_set(), before + 30 * kMebibyte) << accessor;
  }
}

TEST(Memory, TrianglesOfWhichTwoCornersAreInOnePlaceAreNotKept) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  const Scene scene = load(
      folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\nf 1 2 4\n"), warnings);
  EXPECT_EQ(triangle_count(scene), 1U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("1 triangles"), std::string::npos) << warnings[0];
}

TEST(Memory, AccessorsThatManyPrimitivesShareAddUp) {
  const tests::TemporaryFolder folder;
  constexpr int kVertices = 100'000;
  std::string positions;
  for (int i = 0; i < kVertices * 3; ++i) {
    const auto value = static_cast<float>(i * i % 1013);
    positions.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  folder.write("a.bin", positions);
  const std::string size = std::to_string(positions.size());
  std::string text =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"accessors":[{"type":"VEC3",)"
      R"("componentType":5126,"bufferView":0,"count":)" +
      std::to_string(kVertices) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + size +
      R"(}],"buffers":[{"uri":"a.bin","byteLength":)" + size + R"(}],"materials":[{}],"meshes":[)" +
      R"({"primitives":[)";
  for (int i = 0; i < 1000; ++i) {
    text += std::string(i > 0 ? "," : "") + R"({"attributes":{"POSITION":0},"material":0})";
  }
  const auto path = folder.write("a.gltf", text + "]}]}");
  const std::uint64_t before = files::resident_set();
  EXPECT_EQ(refusal(path, files::MemoryBudget(before + 100 * kMebibyte)), files::Cause::memory);
  EXPECT_LT(files::resident_set(), before + 110 * kMebibyte);
}

TEST(Memory, TexturesAreCheckedBeforeTheyAreDecoded) {
  const tests::TemporaryFolder folder;
  folder.write("0.png", blank_png(4000, 7));
  image::read_info(folder / "0.png");  // loads libraries
  const auto path = folder.write(
      "a.gltf", gltf(R"("bufferView":0,"count":3)", primitives(1) + "," + materials(1)));
  const std::uint64_t before = files::resident_set();
  EXPECT_EQ(refusal(path, files::MemoryBudget(before + 50 * kMebibyte)), files::Cause::memory);
  EXPECT_LT(files::resident_set(), before + 50 * kMebibyte);
}

TEST(Memory, EqualTexturesAreReadOnce) {
  const tests::TemporaryFolder folder;
  constexpr int kTextures = 12;
  for (int i = 0; i < kTextures; ++i) {
    folder.write(std::to_string(i) + ".png", blank_png(64, i == 5 ? 1 : 2));
  }
  std::vector<std::string> warnings;
  const Scene scene =
      load(folder.write("a.gltf", gltf(R"("bufferView":0,"count":3)",
                                       primitives(kTextures) + "," + materials(kTextures))),
           warnings);
  ASSERT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(scene.textures[0].name, "0.png");
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    EXPECT_EQ(scene.materials[i].base_colour_texture, i == 5 ? 1U : 0U);
  }
}

TEST(Memory, TextFilesAreCheckedBeforeTheyAreParsed) {
  const tests::TemporaryFolder folder;
  std::string obj;
  for (int i = 0; i < 600'000; ++i) obj += "v " + std::to_string(i) + " 0 1\n";
  for (int i = 3; i < 600'000; ++i) obj += "f " + std::to_string(i) + " 1 2\n";
  const auto path = folder.write("a.obj", obj);
  std::string json = "[0";
  for (int i = 0; i < 2'000'000; ++i) json += ",0";
  const auto values =
      folder.write("a.gltf", R"({"asset":{"version":"2.0"},"extras":)" + json + "]}");
  obj = json = {};
  const std::uint64_t before = files::resident_set();
  EXPECT_EQ(refusal(path, files::MemoryBudget(before + 20 * kMebibyte)), files::Cause::memory);
  EXPECT_EQ(refusal(values, files::MemoryBudget(before + 20 * kMebibyte)), files::Cause::memory);
}

}  // namespace
}  // namespace delray::scenes
