#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "files/error.h"
#include "files/read_file.h"
#include "scenes/generate.h"
#include "scenes/load.h"
#include "scenes/write_glb.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

// The error of a file that must be refused; its message names the file.
std::string refusal(const tests::TemporaryFolder& folder, const std::string& name,
                    const std::string& content) {
  const std::filesystem::path path = folder.write(name, content);
  std::vector<std::string> warnings;
  try {
    load(path, warnings);
  } catch (const files::FileError& e) {
    EXPECT_EQ(e.cause(), files::Cause::input);
    EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
    return e.what();
  }
  ADD_FAILURE() << name << " was read";
  return {};
}

// True if the file could be read, false if it was refused; anything else fails the test.
bool is_read(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  try {
    const Scene scene = load(path, warnings);
    for (const Mesh& mesh : scene.meshes) {
      for (const glm::uvec3& t : mesh.triangles) {
        EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
      }
      for (const glm::vec3& p : mesh.positions) EXPECT_LE(glm::length(glm::dvec3(p)), 2e18);
    }
    return true;
  } catch (const files::FileError&) {
    return false;
  }
}

std::vector<SampleFile> all_samples(const tests::TemporaryFolder& folder) {
  std::vector<SampleFile> samples = sample_files();
  write_glb(folder / "sample.glb", generate("gen:cornell"));
  samples.push_back({"sample.glb", files::read_file(folder / "sample.glb"), 32});
  return samples;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BrokenFile, MissingEmptyAndFolder) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  for (const char* name : {"none.obj", "none.glb", "none"}) {
    EXPECT_THROW(load(folder / name, warnings), files::FileError);
  }
  EXPECT_THROW(load(folder.path(), warnings), files::FileError);
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.gltf", "a.glb", "a.txt"}) {
    refusal(folder, name, "");
    refusal(folder, name, "\n");
    refusal(folder, name, std::string(3000, '\0'));
    refusal(folder, name, "this is not a scene\nat all\n");
  }
}

TEST(BrokenFile, TruncatedAnywhere) {
  const tests::TemporaryFolder folder;
  for (const SampleFile& sample : all_samples(folder)) {
    SCOPED_TRACE(sample.name);
    const std::size_t step = std::max<std::size_t>(1, sample.content.size() / 150);
    for (std::size_t size = 0; size < sample.content.size(); size += step) {
      const bool read = is_read(folder.write(sample.name, sample.content.substr(0, size)));
      // A line is a whole file in OBJ, and what is left of a number may be a number.
      const bool must_fail = sample.name != "sample.obj" && size + 12 < sample.content.size();
      EXPECT_FALSE(must_fail && read) << "cut at byte " << size;
    }
  }
}

TEST(BrokenFile, RandomBytesAnywhere) {
  const tests::TemporaryFolder folder;
  std::mt19937 random(7);
  for (const SampleFile& sample : all_samples(folder)) {
    SCOPED_TRACE(sample.name);
    for (int trial = 0; trial < 150; ++trial) {
      std::string content = sample.content;
      const int changes = 1 + static_cast<int>(random() % 4);
      for (int i = 0; i < changes; ++i)
        content[random() % content.size()] = static_cast<char>(random());
      is_read(folder.write(sample.name, content));
    }
    for (int trial = 0; trial < 20; ++trial) {
      std::string noise = sample.content.substr(0, random() % 20);
      while (noise.size() < 400) noise.push_back(static_cast<char>(random()));
      is_read(folder.write(sample.name, noise));
    }
  }
}

TEST(BrokenFile, CoordinatesThatAreNotFinite) {
  const tests::TemporaryFolder folder;
  for (const char* bad : {"nan", "inf", "-inf", "1e39", "-1e300", "x", "1e999"}) {
    SCOPED_TRACE(bad);
    const std::string value(bad);
    EXPECT_NE(refusal(folder, "a.obj", replaced(sample_obj(), "v 1 1 0", "v 1 " + value + " 0"))
                  .find("line 5"),
              std::string::npos);
    EXPECT_NE(refusal(folder, "a.off", replaced(sample_off(), "1 1 0", "1 " + value + " 0"))
                  .find("line 6"),
              std::string::npos);
    EXPECT_NE(
        refusal(folder, "a.stl", replaced(sample_stl_text(), "vertex 1 1 0", "vertex 1 1 " + value))
            .find("line 6"),
        std::string::npos);
    EXPECT_NE(refusal(folder, "a.ply",
                      replaced(sample_ply_text(), "1 1 0 0 0 255", value + " 1 0 0 0 255"))
                  .find("line 16"),
              std::string::npos);
  }
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30F}) {
    std::string bytes;
    append(bytes, bad);
    std::string ply = sample_ply_binary(false), stl = sample_stl_binary();
    ply.replace(ply.find("end_header\n") + 11 + 12, 4, bytes);
    EXPECT_NE(refusal(folder, "b.ply", ply).find("byte"), std::string::npos);
    stl.replace(84 + 12, 4, bytes);
    refusal(folder, "b.stl", stl);
    std::string gltf_bytes;
    for (const float x : {0.0F, bad, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F})
      append(gltf_bytes, x);
    refusal(folder, "b.gltf",
            R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:;base64,)" +
                base64(gltf_bytes) + "\"}]}");
  }
}

TEST(BrokenFile, IndicesOutOfRange) {
  const tests::TemporaryFolder folder;
  for (const char* bad : {"6", "-6", "0", "4000000000", "99999999999999999999"}) {
    EXPECT_NE(refusal(folder, "a.obj", replaced(sample_obj(), "f -5", "f " + std::string(bad)))
                  .find("line 15"),
              std::string::npos);
  }
  refusal(folder, "a.obj", replaced(sample_obj(), "1/1", "1/7"));
  refusal(folder, "a.obj", replaced(sample_obj(), "1/1", "1//1"));
  for (const char* bad : {"5", "-1", "4000000000"}) {
    const std::string index(bad);
    refusal(folder, "a.off", replaced(sample_off(), "3 0 1 4", "3 0 1 " + index));
    refusal(folder, "a.ply", replaced(sample_ply_text(), "3 0 1 4", "3 0 1 " + index));
  }
  std::string ply = sample_ply_binary(false);
  ply[ply.size() - 4] = 5;
  refusal(folder, "b.ply", ply);
  ply[ply.size() - 1] = '\xFF';
  refusal(folder, "b.ply", ply);
}

TEST(BrokenFile, HugeCounts) {
  const tests::TemporaryFolder folder;
  for (const char* count :
       {"4000000000", "100000", "18446744073709551615", "99999999999999999999999", "-1"}) {
    SCOPED_TRACE(count);
    const std::string n(count);
    refusal(folder, "a.ply", replaced(sample_ply_text(), "vertex 5", "vertex " + n));
    refusal(folder, "a.ply", replaced(sample_ply_text(), "face 2", "face " + n));
    refusal(folder, "b.ply", replaced(sample_ply_binary(false), "vertex 5", "vertex " + n));
    refusal(folder, "b.ply", replaced(sample_ply_binary(true), "face 3", "face " + n));
    refusal(folder, "a.off", replaced(sample_off(), "5 2 0", n + " 2 0"));
    refusal(folder, "a.off", replaced(sample_off(), "5 2 0", "5 " + n + " 0"));
    refusal(folder, "a.ply", replaced(sample_ply_text(), "4 0 1 2 3", n + " 0 1 2 3"));
    refusal(folder, "a.off", replaced(sample_off(), "4 0 1 2 3", n + " 0 1 2 3"));
    refusal(folder, "a.gltf", replaced(sample_gltf(), "\"count\":5", "\"count\":" + n));
    refusal(folder, "a.gltf", replaced(sample_gltf(), "\"count\":9", "\"count\":" + n));
    refusal(folder, "a.gltf", replaced(sample_gltf(), "\"byteLength\":60", "\"byteLength\":" + n));
    refusal(folder, "a.gltf", replaced(sample_gltf(), "\"byteLength\":78", "\"byteLength\":" + n));
  }
  std::string stl = sample_stl_binary();
  stl.replace(80, 4, "\xFF\xFF\xFF\xFF");
  EXPECT_NE(refusal(folder, "a.stl", stl).find("4294967295"), std::string::npos);
}

TEST(BrokenFile, GltfThatIsNotSound) {
  const tests::TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& place) {
    const std::string what = refusal(folder, "a.gltf", replaced(sample_gltf(), from, to));
    EXPECT_NE(what.find(place), std::string::npos) << what;
  };
  refused("\"2.0\"", "\"1.0\"", "asset.version");
  refused("\"children\":[1]", "\"children\":[0]", "nodes[0]");
  refused("\"children\":[1]", "\"children\":[1,1]", "nodes[1]");
  refused("\"children\":[1]", "\"children\":[2]", "nodes[0].children[0]");
  refused("\"children\":[1]", "\"children\":{}", "nodes[0].children");
  refused("\"scale\":[2,2,2]", "\"scale\":[2,2]", "nodes[1].scale");
  refused("\"scale\":[2,2,2]", "\"scale\":[2,2,\"x\"]", "nodes[1].scale[2]");
  refused("\"scale\":[2,2,2]", "\"scale\":[1e18,1e18,1e18],\"translation\":[1e18,0,0]", "");
  refused("\"mesh\":0,\"translation\"", "\"mesh\":7,\"translation\"", "nodes[0].mesh");
  refused("\"POSITION\":0", "\"POSITION\":1", "accessors[1]");
  refused("\"POSITION\":0", "\"POSITION\":0,\"NORMAL\":1", "accessors[1]");
  refused("\"indices\":1", "\"indices\":0", "accessors[0]");
  refused("\"material\":0", "\"material\":3", "material");
  refused("\"material\":0", "\"material\":-1", "material");
  refused("\"material\":0", "\"material\":0.5", "material");
  refused("5126", "5124", "componentType");
  refused("\"VEC3\"", "\"VEC5\"", "type");
  refused("\"bufferView\":1", "\"bufferView\":2", "bufferView");
  refused("\"byteOffset\":60", "\"byteOffset\":61", "bufferViews[1]");
  refused("\"buffer\":0,\"byteOffset\"", "\"buffer\":1,\"byteOffset\"", "bufferViews[1].buffer");
  refused("base64,", "base64,!", "buffers[0].uri");
  const std::string sound = sample_gltf();
  const std::size_t uri = sound.find("data:");
  refused(sound.substr(uri, sound.find('"', uri) - uri), "none.bin", "none.bin");
  refused("\"scene\":0", "\"extensionsRequired\":[\"EXT_meshopt_compression\"]",
          "EXT_meshopt_compression");
  refused("\"scene\":0", "\"scene\":0,\"extensionsRequired\":[\"KHR_materials_nonsense\"]",
          "KHR_materials_nonsense");
  refused("\"scene\":0", "\"scene\":5", "scene");
}

TEST(BrokenFile, DeepNestingIsNoDanger) {
  const tests::TemporaryFolder folder;
  refusal(folder, "a.gltf", "{\"asset\":" + std::string(200'000, '['));
  std::string nodes = "{\"mesh\":0,\"children\":[1]}";
  constexpr int kDepth = 20'000;
  for (int i = 1; i < kDepth; ++i) nodes += ",{\"children\":[" + std::to_string(i + 1) + "]}";
  nodes += ",{\"mesh\":0}";
  std::string gltf = sample_gltf();
  const std::size_t begin = gltf.find("\"nodes\":[{") + 9, end = gltf.find("],\n\"meshes\"");
  gltf.replace(begin, end - begin, nodes);
  EXPECT_TRUE(is_read(folder.write("b.gltf", gltf)));
}

TEST(BrokenFile, NoTriangles) {
  const tests::TemporaryFolder folder;
  for (const auto& [name, content] : {std::pair{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
                                      std::pair{"b.obj", "v 0 0 0\nv 1 0 0\nf 1 2\nl 1\n"},
                                      std::pair{"a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"},
                                      std::pair{"a.stl", "solid\nendsolid\n"}}) {
    refusal(folder, name, content);
  }
  const std::string what =
      refusal(folder, "a.ply",
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n0 0 0\n1 1 1\n");
  EXPECT_NE(what.find("triangulate"), std::string::npos);
}

TEST(BrokenFile, EveryFileOfTheCorpusIsReadOrRefused) {
  const std::filesystem::path corpus =
      std::filesystem::path(DELRAY_SOURCE_DIR) / "tests/corpus/scene";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    SCOPED_TRACE(entry.path().filename());
    is_read(entry.path());
    ++files;
  }
  EXPECT_GT(files, 0) << corpus;
}

TEST(BrokenGltf, LightIsNeverNegative) {
  const tests::TemporaryFolder folder;
  const auto document = [](const std::string& light, const std::string& emission,
                           const std::string& sky) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0],
      "extras": {"delray": {"environment": {"zenith": )" +
           sky +
           R"(}}}}],
      "nodes": [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
           R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "materials": [{"emissiveFactor": )" +
           emission + R"(}], "extensions": {"KHR_lights_punctual": {"lights": [)" + light + "]}}}";
  };
  const std::string light = R"({"type": "point", "intensity": 1})";
  const std::string negative = "should not be negative";
  for (const auto& [content, place] : std::vector<std::pair<std::string, std::string>>{
           {document(R"({"type": "point", "intensity": -5})", "[0, 0, 0]", "[1, 1, 1]"),
            "lights[0].intensity"},
           {document(R"({"type": "point", "color": [1, -1, 1]})", "[0, 0, 0]", "[1, 1, 1]"),
            "lights[0].color[1]"},
           {document(light, "[0, 0, -2]", "[1, 1, 1]"), "materials[0].emissiveFactor[2]"},
           {document(light, "[0, 0, 0]", "[-1, 1, 1]"), "environment.zenith[0]"}}) {
    const std::string why = refusal(folder, "a.gltf", content);
    EXPECT_NE(why.find(place + ": " + negative), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace delray::scenes
