// Animations, skins and morph targets of files: the poses of the scenes that were written, and
// errors that name the place of what is wrong.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "files/error.h"
#include "files/read_file.h"
#include "scenes/generate.h"
#include "scenes/load.h"
#include "scenes/pose.h"
#include "scenes/write_glb.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

using Json = nlohmann::json;

Scene load_quietly(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Scene scene = load(path, warnings);
  for (const std::string& w : warnings) ADD_FAILURE() << "warning: " << w;
  return scene;
}

TEST(GltfAnimation, PosesOfAFileAreThoseOfTheSceneThatWasWritten) {
  const tests::TemporaryFolder folder;
  for (const char* name : {"gen:machine:1600", "gen:cloth:300", "gen:arm:300"}) {
    Scene scene = generate(name);
    write_glb(folder / "a.glb", scene);
    Scene back = load_quietly(folder / "a.glb");
    ASSERT_EQ(back.instances.size(), scene.instances.size()) << name;
    for (const double t : {0.0, 0.1, 0.9, 1.77, 30.0}) {
      const Movement a = pose(scene, {0, t}), b = pose(back, {0, t});
      EXPECT_EQ(a.instances, b.instances);
      EXPECT_EQ(a.meshes, b.meshes);
      for (std::size_t i = 0; i < scene.instances.size(); ++i)
        EXPECT_EQ(scene.instances[i].transform, back.instances[i].transform) << name << t;
      for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        EXPECT_EQ(scene.meshes[i].positions, back.meshes[i].positions) << name << t;
        EXPECT_EQ(scene.meshes[i].normals, back.meshes[i].normals) << name << t;
      }
    }
  }
}

// A GLB file with another document.
std::string with(const std::string& glb, const std::function<void(Json&)>& change) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  Json json = Json::parse(glb.substr(20, length));
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t size) {
    const auto narrow = static_cast<std::uint32_t>(size);
    return std::string(reinterpret_cast<const char*>(&narrow), sizeof narrow);
  };
  const std::string rest = glb.substr(20 + length);
  return glb.substr(0, 8) + word(20 + text.size() + rest.size()) + word(text.size()) +
         glb.substr(16, 4) + text + rest;
}

class BrokenAnimations : public testing::Test {
 protected:
  std::string content(const char* name) {
    write_glb(folder_ / "a.glb", generate(name));
    return files::read_file(folder_ / "a.glb");
  }
  void expect_error(const std::string& glb, const std::function<void(Json&)>& change,
                    const std::string& what) {
    const auto path = folder_.write("b.glb", with(glb, change));
    std::vector<std::string> warnings;
    try {
      load(path, warnings);
      ADD_FAILURE() << "was read, without " << what;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }
  const tests::TemporaryFolder folder_;
};

TEST_F(BrokenAnimations, OfKeyFrames) {
  const std::string glb = content("gen:cloth:20");
  const auto sampler = [](Json& json) -> Json& { return json["animations"][0]["samplers"][0]; };
  const auto channel = [](Json& json) -> Json& { return json["animations"][0]["channels"][0]; };
  expect_error(
      glb, [&](Json& j) { sampler(j)["interpolation"] = "BEZIER"; },
      "animations[0].samplers[0].interpolation: should be STEP");
  expect_error(
      glb, [&](Json& j) { sampler(j)["interpolation"] = "LINEAR"; }, "key frames of 2");
  expect_error(
      glb, [&](Json& j) { sampler(j)["input"] = sampler(j)["output"]; }, "samplers[0].input");
  expect_error(
      glb, [&](Json& j) { sampler(j)["output"] = 0; }, "components, not 1");
  expect_error(
      glb, [&](Json& j) { sampler(j).erase("input"); }, "is missing");
  expect_error(
      glb, [&](Json& j) { sampler(j)["output"] = 99; }, "samplers[0].output");
  expect_error(
      glb, [&](Json& j) { channel(j)["sampler"] = 1; }, "channels[0].sampler");
  expect_error(
      glb, [&](Json& j) { channel(j)["target"]["path"] = "colour"; },
      "should be translation, rotation, scale or weights");
  expect_error(
      glb, [&](Json& j) { channel(j)["target"]["node"] = 1; }, "without morph targets");
  expect_error(
      glb, [&](Json& j) { channel(j)["target"]["node"] = 77; }, "target.node");
  expect_error(
      glb,
      [&](Json& j) {
        Json& channels = j["animations"][0]["channels"];
        channels.push_back(channels[0]);
      },
      "another channel");
}

TEST_F(BrokenAnimations, OfMorphTargets) {
  const std::string glb = content("gen:cloth:20");
  const auto targets = [](Json& json) -> Json& {
    return json["meshes"][0]["primitives"][0]["targets"];
  };
  expect_error(
      glb, [&](Json& j) { j["nodes"][0]["weights"] = {1}; }, "2 morph targets");
  expect_error(
      glb,
      [&](Json& j) {
        targets(j)[0]["POSITION"] = j["meshes"][2]["primitives"][0]["attributes"]["POSITION"];
      },
      "vertices");
  expect_error(
      glb,
      [&](Json& j) {
        Json second = j["meshes"][0]["primitives"][0];
        second["targets"].erase(1);
        j["meshes"][0]["primitives"].push_back(second);
      },
      "the first primitive 2");
  // Far enough away for squares to overflow.
  expect_error(
      glb,
      [&](Json& j) {
        j["nodes"][0]["weights"] = {1e30, 0};
      },
      "larger than 1e18");
}

TEST_F(BrokenAnimations, OfSkins) {
  const std::string glb = content("gen:arm:60");
  const auto attributes = [](Json& json) -> Json& {
    return json["meshes"][0]["primitives"][0]["attributes"];
  };
  expect_error(
      glb, [&](Json& j) { j["skins"][0]["joints"] = Json::array(); }, "at least one node");
  expect_error(
      glb,
      [&](Json& j) {
        j["skins"][0]["joints"] = {1, 2};
      },
      "is not one of 2");
  expect_error(
      glb, [&](Json& j) { j["skins"][0]["joints"].push_back(2); }, "8 matrices");
  expect_error(
      glb,
      [&](Json& j) {
        j["nodes"].push_back(Json::object());
        j["skins"][0]["joints"][3] = j["nodes"].size() - 1;
      },
      "the scene does not show");
  expect_error(
      glb, [&](Json& j) { attributes(j).erase("WEIGHTS_0"); }, "no JOINTS_0");
  expect_error(
      glb, [&](Json& j) { attributes(j)["JOINTS_0"] = attributes(j)["WEIGHTS_0"]; },
      "is no number of one");
  expect_error(
      glb, [&](Json& j) { j["nodes"][0]["skin"] = 4; }, "nodes[0].skin");
  expect_error(
      glb,
      [&](Json& j) {
        Json& node = j["nodes"][2];
        node.erase("translation");
        node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      },
      "a node with a matrix");
}

// Files of which somebody else made the skin: weights that sum up to anything, and none.
TEST(GltfAnimation, WeightsAreMadeToSumUpToOne) {
  const tests::TemporaryFolder folder;
  Scene scene = generate("gen:arm:60");
  Deformation& by = scene.animations.meshes[0].deformation;
  for (float& weight : by.weights) weight *= 0.5F;
  for (std::size_t k = 0; k < 4; ++k) by.weights[k] = 0;
  write_glb(folder / "a.glb", scene);
  const Scene back = load_quietly(folder / "a.glb");
  const Deformation& read = back.animations.meshes[0].deformation;
  EXPECT_EQ(read.weights[0], 1);
  for (std::size_t i = 0; i < read.weights.size(); i += 4) {
    EXPECT_NEAR(read.weights[i] + read.weights[i + 1] + read.weights[i + 2] + read.weights[i + 3],
                1, 1e-6);
  }
}

}  // namespace
}  // namespace delray::scenes
