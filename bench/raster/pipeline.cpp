// What a pipeline over the frames of an animation gains: transform, rasterize, compose, encode, in
// turn with one frame after the other, beside what formulas 2.1 and 2.2 of Kohout (2004) say of the
// stages' times where frames are alone.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "comm/agreed_pipeline.h"
#include "comm/threads.h"
#include "image/io.h"
#include "raster/render.h"
#include "scenes/camera_path.h"
#include "scenes/generate.h"

using namespace delray;

namespace {

constexpr std::size_t kFrames = 20, kSlots = 4;
constexpr int kTurns = 3;

struct Scene {
  scenes::Scene scene;
  std::shared_ptr<const shading::Shader> shader;
  std::vector<scenes::Camera> cameras;
};

// The stages' times on rank 0.
parallel::PipelineTimes animate(const Scene& scene, raster::Renderer& renderer,
                                comm::Communicator& communicator,
                                const raster::RenderOptions& options, std::size_t slots,
                                const std::filesystem::path& folder) {
  struct Slot {
    std::unique_ptr<raster::FrameInSteps> steps;
    raster::Picture picture;
  };
  std::vector<Slot> frames(slots);
  const std::vector<parallel::PipelineStage> stages = {
      {"transform", true,
       [&](std::size_t i, std::size_t slot) {
         frames[slot].steps = renderer.begin(communicator, scene.cameras[i], options);
         frames[slot].steps->transform();
       }},
      {"rasterize", true, [&](std::size_t, std::size_t slot) { frames[slot].steps->rasterize(); }},
      {"compose", true,
       [&](std::size_t, std::size_t slot) {
         frames[slot].picture = frames[slot].steps->compose().picture;
       }},
      {"encode", false, [&](std::size_t i, std::size_t slot) {
         if (communicator.rank() != 0) return;
         image::write_image((folder / (std::to_string(i) + ".png")).string(),
                            std::get<image::Image8>(frames[slot].picture), {});
       }}};
  return comm::run_agreed_pipeline(communicator, kFrames, slots, stages, 2);
}

void compare(const std::string& name, const Scene& scene, const raster::RenderOptions& options,
             int ranks, int threads, const std::filesystem::path& folder) {
  std::vector<parallel::PipelineTimes> alone;
  std::vector<double> sequential, in_pipeline, predicted;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    raster::Renderer renderer(scene.scene, scene.shader);
    for (int turn = -1; turn < kTurns; ++turn) {  // the first to warm up
      const auto one = animate(scene, renderer, communicator, options, 1, folder);
      const auto many = animate(scene, renderer, communicator, options, kSlots, folder);
      if (turn < 0 || communicator.rank() != 0) continue;
      alone.push_back(one);
      sequential.push_back(one.seconds);
      in_pipeline.push_back(many.seconds);
      predicted.push_back(parallel::predicted_seconds(one, kFrames));
    }
  });
  std::printf("%-20s %d x %d", name.c_str(), ranks, threads);
  for (std::size_t stage = 0; stage < alone[0].stages.size(); ++stage) {
    std::vector<double> seconds;
    for (const parallel::PipelineTimes& times : alone) seconds.push_back(times.stages[stage]);
    std::printf(" %7.1f", bench::median(seconds) / kFrames * 1e3);
  }
  const double whole = bench::median(sequential), overlapped = bench::median(in_pipeline);
  std::printf("   %8.1f %8.1f %8.2f %8.2f\n", whole / kFrames * 1e3, overlapped / kFrames * 1e3,
              whole / overlapped, whole / bench::median(predicted));
  bench::report_ratio(
      name + ", " + std::to_string(ranks) + " x " + bench::thread_count(threads) + ", gain",
      whole / overlapped, bench::Better::higher);
  std::fflush(stdout);
}

}  // namespace

// [SCENE [RANKS THREADS]]: a scene as delray render takes it, gen:KIND[:TRIANGLES[:SEED]].
int main(int argc, char** argv) {
  std::vector<std::string> names = {"gen:terrain:1000000", "gen:field"};
  if (argc > 1) names = {argv[1]};
  std::vector<std::pair<int, int>> processors = {{1, 1}, {1, 2}, {2, 1}};
  if (argc > 3) processors = {{std::stoi(argv[2]), std::stoi(argv[3])}};
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("raster_pipeline_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::printf(
      "ms a frame, %zu frames\n%-20s ranks x threads; one alone: transform, rasterize, compose, "
      "encode; one by one, %zu at once; gain, with a processor for each stage\n",
      kFrames, "scene", kSlots);
  for (const std::string& name : names) {
    Scene scene;
    scene.scene = scenes::generate(name);
    scene.shader = std::make_shared<const shading::Shader>(shading::make_shader(scene.scene));
    scene.cameras = scenes::turntable(scene.scene.cameras[0], static_cast<int>(kFrames));
    raster::RenderOptions options;
    options.width = 1920;
    options.height = 1080;
    options.lighting = raster::Lighting::gouraud;
    for (const auto& [ranks, threads] : processors)
      compare(name, scene, options, ranks, threads, folder);
  }
  std::filesystem::remove_all(folder);
}
