// The two engines see the same scene through the same camera.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "comm/threads.h"
#include "image/compare.h"
#include "image/srgb.h"
#include "raster/render.h"
#include "raytrace/render.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

namespace delray::tests {
namespace {

constexpr int kFullWidth = 1920, kFullHeight = 1080;

enum class Cut { none, in_the_middle };

// Pixels that only one of the engines covers.
std::uint64_t coverage_difference(scenes::Scene scene, bool orthographic = false,
                                  Cut cut = Cut::none) {
  scenes::Camera camera =
      scenes::camera_around(scene, "default", static_cast<float>(kFullWidth) / kFullHeight);
  if (orthographic) {
    const float distance = glm::distance(camera.eye, camera.at);
    camera.height = 0.7F * distance * std::tan(glm::radians(camera.vertical_fov * 0.5F));
    camera.near = 0.5F * distance;  // cuts into some
  }
  if (cut == Cut::in_the_middle) camera.near = glm::distance(camera.eye, camera.at);
  complete(scene, camera);
  std::uint64_t differs = 0;
  comm::run_threads(1, 2, [&](comm::Communicator& communicator) {
    raster::RenderOptions raster_options;
    raster_options.width = kFullWidth;
    raster_options.height = kFullHeight;
    raster_options.float_pixels = true;
    raster_options.lighting = raster::Lighting::gouraud;
    raytrace::RenderOptions trace_options;
    trace_options.width = kFullWidth;
    trace_options.height = kFullHeight;
    trace_options.trace.depth = 0;
    const raster::Result drawn = raster::render(communicator, scene, camera, raster_options);
    const raytrace::Result traced = raytrace::render(communicator, scene, camera, trace_options);
    differs = compare(std::get<image::ImageF>(drawn.picture), traced.image).coverage_differs;
  });
  return differs;
}

// A shift by half a pixel would differ in 0.08 % of the pixels.
constexpr std::uint64_t kAllowed =
    static_cast<std::uint64_t>(kFullWidth) * kFullHeight / 20000;  // 0.005 %

class GeneratedScenes : public testing::TestWithParam<const char*> {};

TEST_P(GeneratedScenes, HaveTheSameSilhouettes) {
  EXPECT_LE(coverage_difference(scenes::generate(GetParam())), kAllowed);
}

TEST_P(GeneratedScenes, HaveTheSameSilhouettesAlongParallelRays) {
  EXPECT_LE(coverage_difference(scenes::generate(GetParam()), true), kAllowed);
}

TEST(Engines, HaveTheSameSilhouettesOfWhatANearPlaneLeaves) {
  EXPECT_LE(coverage_difference(scenes::generate("gen:city:20000"), false, Cut::in_the_middle),
            kAllowed);
}

INSTANTIATE_TEST_SUITE_P(Engines, GeneratedScenes,
                         testing::Values("gen:terrain:50000", "gen:spheres:20000", "gen:city:20000",
                                         "gen:field:100000"));

class RealModels : public testing::TestWithParam<const char*> {};

TEST_P(RealModels, HaveTheSameSilhouettes) {
  const std::filesystem::path path = std::filesystem::path(DELRAY_SHARED_DATA) / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  std::vector<std::string> warnings;
  EXPECT_LE(coverage_difference(scenes::load(path, warnings)), kAllowed);
}
INSTANTIATE_TEST_SUITE_P(Engines, RealModels,
                         testing::Values("stanford-bunny.obj", "teapot.obj", "spot.obj",
                                         "armadillo.obj", "nefertiti.obj", "2CylinderEngine.glb",
                                         "drone/scene.gltf"));

}  // namespace
}  // namespace delray::tests
