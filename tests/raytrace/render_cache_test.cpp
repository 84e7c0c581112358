// Pictures of an animation of which most pixels come from the frames before.
#include "raytrace/render_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "comm/threads.h"
#include "raytrace/render.h"
#include "scenes/camera_path.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

constexpr int kWidth = 120, kHeight = 90;

RenderOptions transparent() {
  RenderOptions options = small(kWidth, kHeight);
  options.trace.background = TraceOptions::Background::transparent;
  return options;
}

// Some balls in front of nothing.
scenes::Scene cached_balls() {
  scenes::Scene scene;
  for (int i = 0; i < 5; ++i) {
    const auto x = static_cast<float>(i % 3 - 1), z = static_cast<float>(i / 2 - 1);
    add(scene, sphere(10), placed(0.4F + 0.1F * static_cast<float>(i), {x, 0.3F * z, z}))
        .base_colour = {0.2F + 0.15F * static_cast<float>(i), 0.5F, 0.7F, 1};
  }
  scenes::Camera camera;
  camera.eye = {0, 1.5F, 5};
  camera.at = {0, 0, 0};
  scene.cameras = {camera};
  scenes::complete(scene, camera);
  return scene;
}

struct Difference {
  double mean = 0;  // of 255, over pixels and frames
  std::uint64_t traced = 0, pixels = 0;
};

Difference difference_over(const scenes::Scene& scene, std::span<const scenes::Camera> cameras,
                           double share) {
  const Tracer tracer = make_tracer(scene);
  Difference result;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    RenderCache cache(kWidth, kHeight, share);
    for (const scenes::Camera& camera : cameras) {
      RenderOptions options = transparent();
      const Result full = render(communicator, tracer, camera, options);
      const scenes::View view = scenes::make_view(camera, kWidth, kHeight);
      options.part.pixels = cache.plan(view);
      Result part = render(communicator, tracer, camera, options);
      EXPECT_EQ(part.statistics.rays.primary, cache.traced());
      cache.complete(view, part.image);
      for (std::size_t i = 0; i < full.image.pixels(); ++i) {
        const image::RgbaF &a = full.image.colour[i], &b = part.image.colour[i];
        if (options.part.pixels[i] != 0) {
          EXPECT_EQ(a.r, b.r);
        }
        for (const auto& [x, y] : {std::pair{a.r, b.r}, {a.g, b.g}, {a.b, b.b}})
          result.mean += 255.0 / 3 * std::abs(double{x} - double{y});
      }
      result.traced += cache.traced();
      result.pixels += full.image.pixels();
    }
  });
  result.mean /= static_cast<double>(result.pixels);
  return result;
}

TEST(RenderCache, SurfacesStayAsTheyAreWhileTheCameraStands) {
  const scenes::Scene scene = scenes::generate("gen:cornell:100");
  const Tracer tracer = make_tracer(scene);
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    RenderCache cache(kWidth, kHeight, 0.1);
    const scenes::View view = scenes::make_view(scene.cameras[0], kWidth, kHeight);
    RenderOptions options = transparent();
    const image::ImageF full = render(communicator, tracer, scene.cameras[0], options).image;
    for (int frame = 0; frame < 4; ++frame) {
      options.part.pixels = cache.plan(view);
      image::ImageF part = render(communicator, tracer, scene.cameras[0], options).image;
      cache.complete(view, part);
      for (std::size_t i = 0; i < full.pixels(); ++i) {
        if (full.depth[i] != image::kEmptyDepth) {
          ASSERT_EQ(part.colour[i].g, full.colour[i].g);
        }
      }
      EXPECT_LE(cache.traced(), frame == 0 ? full.pixels() : full.pixels() / 8);
    }
  });
}

// Six degrees a frame, as a turntable of 60 frames has them.
TEST(RenderCache, AQuarterOfTheRaysIsAboutThePicture) {
  const scenes::Scene scene = cached_balls();
  const std::vector<scenes::Camera> cameras = scenes::turntable(scene.cameras[0], 60);
  const Difference turned = difference_over(scene, std::span(cameras).first(12), 0.25);
  EXPECT_LE(turned.mean, 1);
  EXPECT_GT(turned.mean, 0);
  // Of the first frame all pixels are traced, then the share and what has to be.
  const double pixels = kWidth * kHeight;
  EXPECT_GT(static_cast<double>(turned.traced), pixels * (1 + 11 * 0.2));
  EXPECT_LT(static_cast<double>(turned.traced), pixels * (1 + 11 * 0.4));
}

// Reflections move against the balls that show them: what is carried over would be wrong by more.
TEST(RenderCache, ReflectionsAreTracedAnew) {
  scenes::Scene scene = cached_balls();
  for (scenes::Material& material : scene.materials) {
    material.metallic = 1;
    material.roughness = 0;
    material.base_colour = {0.9F, 0.9F, 0.9F, 1};
  }
  const std::vector<scenes::Camera> cameras = scenes::turntable(scene.cameras[0], 60);
  const Difference turned = difference_over(scene, std::span(cameras).first(12), 0.25);
  EXPECT_LE(turned.mean, 2);
  const double pixels = kWidth * kHeight;
  EXPECT_GT(static_cast<double>(turned.traced), pixels * (1 + 11 * 0.27));
  EXPECT_LT(static_cast<double>(turned.traced), pixels * 11);
}

TEST(RenderCache, OfWhatIsNotThereNothingIsTaken) {
  RenderCache cache(8, 8, 0.5);
  scenes::Camera camera;
  const scenes::View view = scenes::make_view(camera, 8, 8);
  EXPECT_EQ(std::ranges::count(cache.plan(view), 1), 64);
  image::ImageF picture(8, 8);
  image::clear(picture);
  cache.complete(view, picture);
  const auto traced = std::ranges::count(cache.plan(view), 1);
  EXPECT_GT(traced, 8);
  EXPECT_LT(traced, 56);
  picture.colour[0] = {9, 9, 9, 9};
  cache.complete(view, picture);
  camera.at = camera.eye + (camera.eye - camera.at);  // looks back
  cache.plan(scenes::make_view(camera, 8, 8));
}

}  // namespace
}  // namespace delray::raytrace
