// Pictures along parallel rays.
#include <gtest/gtest.h>

#include "comm/threads.h"
#include "raster/combinations.h"
#include "raster/render.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/random_scene.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

Result rendered_in_parallel(const scenes::Scene& scene, const scenes::Camera& camera,
                            const RenderOptions& options, int ranks = 1) {
  Result result;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Result mine = render(communicator, scene, camera, options);
    if (communicator.rank() == 0) result = std::move(mine);
  });
  return result;
}

// The near plane cuts the scene.
scenes::Camera camera() {
  scenes::Camera camera = random_scene_camera();
  camera.height = 2.5F;
  camera.near = 2;
  camera.far = 6;
  return camera;
}

// A square of side 1 at each of two distances, beside each other.
TEST(Orthographic, WhatIsFarIsAsLargeAsWhatIsNear) {
  scenes::Scene scene;
  scene.materials.emplace_back();
  scene.meshes.emplace_back();
  scene.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  scene.meshes[0].triangles = {{0, 1, 2}, {0, 2, 3}};
  glm::mat4x3 left(1.0F), right(1.0F);
  left[3] = {-1.5F, -0.5F, 0};
  right[3] = {0.5F, -0.5F, -50};
  scene.instances = {{0, left}, {0, right}};
  scenes::Camera camera;
  camera.eye = {0, 0, 10};
  camera.height = 4;
  camera.far = 100;
  RenderOptions options;
  options.width = 80;
  options.height = 40;
  options.float_pixels = true;
  const Result result = rendered_in_parallel(scene, camera, options);
  const auto& picture = std::get<image::ImageF>(result.picture);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 80; ++x) {
      const bool in_rows = y >= 15 && y < 25;
      const bool on_left = in_rows && x >= 25 && x < 35, on_right = in_rows && x >= 45 && x < 55;
      const float depth = picture.depth[static_cast<std::size_t>(y * 80 + x)];
      if (on_left) {
        EXPECT_NEAR(depth, 10, 1e-4) << x << " " << y;
      } else if (on_right) {
        EXPECT_NEAR(depth, 60, 1e-4) << x << " " << y;
      } else {
        EXPECT_EQ(depth, image::kEmptyDepth) << x << " " << y;
      }
    }
  }
}

TEST(Orthographic, AllStrategiesGiveTheSamePicture) {
  for (const bool transparent : {false, true}) {
    const scenes::Scene scene = transparent ? transparent_scene(21) : random_scene(21);
    RenderOptions base;
    base.width = 70;
    base.height = 50;
    const Result expected = rendered_in_parallel(scene, camera(), base);
    EXPECT_GT(expected.statistics.fragments, 1000U);
    int turn = 0;
    for (const RenderOptions& options : combinations(base)) {
      if (++turn % 4 != 0) continue;
      EXPECT_TRUE(
          same_bytes(rendered_in_parallel(scene, camera(), options, 3).picture, expected.picture))
          << name_of(options);
    }
  }
}

TEST(Orthographic, EveryInstructionSetAndShadeGivesTheSamePicture) {
  for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
    const scenes::Scene scene = random_scene(23);
    RenderOptions options;
    options.width = 133;
    options.height = 77;
    options.lighting = lighting;
    const Result expected = rendered_in_parallel(scene, camera(), options);
    options.shade = Shade::immediate;
    EXPECT_TRUE(
        same_bytes(rendered_in_parallel(scene, camera(), options).picture, expected.picture));
    options.shade = Shade::deferred;
    tests::for_each_target([&] {
      EXPECT_TRUE(
          same_bytes(rendered_in_parallel(scene, camera(), options).picture, expected.picture));
    });
  }
}

}  // namespace
}  // namespace delray::raster
