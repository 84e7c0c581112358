#include "apps/input/scene_input.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "apps/input/coloured_points.h"
#include "scenes/generate.h"
#include "scenes/write_glb.h"
#include "tests/support/temporary_folder.h"

namespace delray::apps {
namespace {

// A scene, and what was offered of it before.
struct Loading {
  LoadedScene loaded;
  std::vector<scenes::Scene> previews;
};
Loading load(const SceneInput& input) {
  Loading loading;
  loading.loaded = load_scene_and_points(
      input, nullptr, [&](scenes::Scene&& some) { loading.previews.push_back(std::move(some)); });
  return loading;
}

SceneInput input_of(const std::string& path) {
  SceneInput input;
  input.file.path = path;
  input.file.paths = {path};
  return input;
}

class ScenePreviews : public testing::Test {
 protected:
  std::string path(const char* name) const { return (folder_.path() / name).string(); }
  // Heights over a grid of n points.
  SceneInput points(int n) {
    std::string text = "x,y,z\n";
    constexpr int kRow = 500;
    for (int i = 0; i < n; ++i)
      text += std::to_string(i % kRow) + "," + std::to_string(i / kRow) + "," +
              std::to_string(i * 7 % 10) + "\n";
    folder_.write("points.csv", text);
    return input_of(path("points.csv"));
  }

  tests::TemporaryFolder folder_;
};

constexpr int kManyPoints = kPointsOfPreview * 6 / 5;

TEST_F(ScenePreviews, SomeOfManyPointsComeBeforeTheirSurface) {
  const Loading loading = load(points(kManyPoints));
  ASSERT_EQ(loading.previews.size(), 1U);
  const scenes::Scene& some = loading.previews[0];
  EXPECT_EQ(scenes::splat_count(some), kManyPoints / 2);
  EXPECT_EQ(scenes::triangle_count(some), 0U);
  EXPECT_GT(scenes::triangle_count(loading.loaded.scene), kManyPoints);
  EXPECT_EQ(some.origin, loading.loaded.scene.origin);
}

TEST_F(ScenePreviews, OfLittleThereIsNone) {
  EXPECT_TRUE(load(points(1000)).previews.empty());
  EXPECT_TRUE(load(input_of("gen:terrain:10000")).previews.empty());
}

TEST_F(ScenePreviews, ManyTrianglesComeInACoarseFormFirst) {
  SceneInput input = input_of(path("terrain.glb"));
  input.colour_by = "z";
  scenes::Scene terrain = scenes::generate("gen:terrain:2100000");
  terrain.meshes[0].normals.clear();
  scenes::write_glb(input.file.path, terrain);
  const Loading loading = load(input);
  ASSERT_EQ(loading.previews.size(), 1U);
  const scenes::Scene &some = loading.previews[0], &whole = loading.loaded.scene;
  EXPECT_GT(scenes::triangle_count(some), 10'000U);
  EXPECT_LE(scenes::triangle_count(some), 200'000U);
  EXPECT_GT(scenes::triangle_count(whole), 2'000'000U);
  EXPECT_EQ(some.origin, whole.origin);
  EXPECT_EQ(some.z_up, whole.z_up);
  EXPECT_TRUE(some.colour_scale) << "colours as they will be";
  const glm::vec3 size = scenes::bounds(whole).size();
  EXPECT_LT(glm::distance(scenes::bounds(some).size(), size), 0.02F * glm::length(size));
}

TEST_F(ScenePreviews, WhatIsWrongWithOneIsNotWrongWithTheScene) {
  int calls = 0;
  const auto load = [&](const SceneInput& input, auto&& preview) {
    const LoadedScene loaded = load_scene_and_points(input, nullptr, [&](scenes::Scene&&) {
      ++calls;
      preview();
    });
    return scenes::triangle_count(loaded.scene) + scenes::splat_count(loaded.scene);
  };
  const SceneInput many = points(kManyPoints);
  EXPECT_GT(load(many, [] { throw std::runtime_error("no preview"); }), 0U);
  EXPECT_GT(load(many, [] { throw std::bad_alloc(); }), 0U);
  EXPECT_GT(load(many, [] { throw 7; }), 0U);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace delray::apps
