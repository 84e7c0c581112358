#include <gtest/gtest.h>

#include "comm/threads.h"
#include "raster/combinations.h"
#include "raster/pipeline/splat.h"
#include "raster/render.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/splat_scene.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

using Kind = scenes::Shape::Kind;

Picture picture_of(const scenes::Scene& scene, const scenes::Camera& camera,
                   const RenderOptions& options, int ranks = 1, int threads = 1) {
  Picture picture;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Picture mine = render(communicator, scene, camera, options).picture;
    if (communicator.rank() == 0) picture = std::move(mine);
  });
  return picture;
}

RenderOptions small_picture(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.block = 16;
  return options;
}

std::size_t covered(const Picture& picture) {
  std::size_t count = 0;
  std::visit([&](const auto& image) {
    for (std::size_t i = 0; i < image.pixels(); ++i) count += image.depth[i] < image::kEmptyDepth;
  }, picture);
  return count;
}

// Every combination of strategies once, with other ranks, threads, samples and lighting each time.
TEST(Splats, HaveOnePictureHoweverTheWorkIsShared) {
  int turn = 0;
  for (const bool with_triangles : {true, false}) {
    for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
      for (const int samples : {1, 2}) {
        const unsigned seed = 100 + static_cast<unsigned>(turn);
        const scenes::Scene scene = splat_scene(seed, with_triangles, 60);
        RenderOptions base = small_picture(83, 71);
        base.lighting = lighting;
        base.supersampling = samples;
        const Picture expected = picture_of(scene, random_scene_camera(), base);
        EXPECT_GT(covered(expected), 1000U);
        int number = 0;
        for (const RenderOptions& options : combinations(base)) {
          if ((++number + turn) % 5 != 0) continue;
          const int ranks = 2 + number % 4, threads = 1 + number % 3;
          EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options, ranks, threads),
                                 expected))
              << name_of(options) << " ranks " << ranks << " seed " << seed;
        }
        ++turn;
      }
    }
  }
}

TEST(Splats, ShadeAtOnceAndOnEveryInstructionSetAlike) {
  for (const bool with_triangles : {true, false}) {
    const scenes::Scene scene = splat_scene(7, with_triangles);
    RenderOptions options = small_picture(150, 131);
    options.float_pixels = true;
    const Picture expected = picture_of(scene, random_scene_camera(), options);
    tests::for_each_target([&] {
      EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options), expected));
    });
    options.shade = Shade::immediate;
    EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options, 1, 3), expected));
  }
}

}  // namespace
}  // namespace delray::raster
