// Frames of an animation that are in the making at the same time: each as if it were alone.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "comm/agreed_pipeline.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raster/strategies.h"
#include "scenes/camera_path.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

constexpr std::size_t kFrames = 5, kSlots = 3;

std::vector<scenes::Camera> around() {
  return scenes::turntable(random_scene_camera(), static_cast<int>(kFrames));
}

// On rank 0.
std::vector<Result> one_by_one(const KindOfPicture& kind) {
  std::vector<Result> results;
  const auto shader = std::make_shared<const shading::Shader>(shading::make_shader(kind.scene));
  comm::run_threads(1, 2, [&](comm::Communicator& communicator) {
    Renderer renderer(kind.scene, shader);
    for (const scenes::Camera& camera : around())
      results.push_back(renderer.render(communicator, camera, kind.options));
  });
  return results;
}

std::vector<Result> in_pipeline(const KindOfPicture& kind, int ranks, int threads,
                                const parallel::Progress* progress = nullptr) {
  std::vector<Result> results(kFrames);
  const auto shader = std::make_shared<const shading::Shader>(shading::make_shader(kind.scene));
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    const std::vector<scenes::Camera> cameras = around();
    Renderer renderer(kind.scene, shader);
    std::vector<std::unique_ptr<FrameInSteps>> slots(kSlots);
    const std::vector<parallel::PipelineStage> stages = {
        {"transform", true,
         [&](std::size_t i, std::size_t slot) {
           slots[slot] = renderer.begin(communicator, cameras[i], kind.options, progress);
           slots[slot]->transform();
         }},
        {"rasterize", true, [&](std::size_t, std::size_t slot) { slots[slot]->rasterize(); }},
        {"compose", true, [&](std::size_t i, std::size_t slot) {
           Result result = slots[slot]->compose();
           if (communicator.rank() == 0) results[i] = std::move(result);
         }}};
    comm::run_agreed_pipeline(communicator, kFrames, kSlots, stages, 2);
  });
  return results;
}

TEST(FrameInSteps, EveryKindOfPictureIsWhatItIsAlone) {
  int turn = 0;
  for (const KindOfPicture& kind : kinds_of_picture(70, 45)) {
    const std::vector<Result> expected = one_by_one(kind);
    const int ranks = 1 + turn % 3, threads = 1 + (turn / 3 + 1) % 3;
    ++turn;
    SCOPED_TRACE(kind.name + ", " + std::to_string(ranks) + " ranks of " + std::to_string(threads) +
                 " threads");
    const std::vector<Result> results = in_pipeline(kind, ranks, threads);
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_TRUE(same_bytes(results[i].picture, expected[i].picture)) << "frame " << i;
      EXPECT_EQ(results[i].statistics.triangles_in, expected[i].statistics.triangles_in);
      EXPECT_EQ(results[i].statistics.ranks.size(), static_cast<std::size_t>(ranks));
      if (ranks == 1) {
        EXPECT_EQ(results[i].statistics.fragments, expected[i].statistics.fragments);
      }
    }
  }
}

TEST(FrameInSteps, ShadingAfterCompositingIsPartOfCompose) {
  KindOfPicture kind{"composited", transparent_scene(4), {}};
  kind.options.width = 60;
  kind.options.height = 50;
  const std::vector<Result> expected = one_by_one(kind);
  kind.options.shade = Shade::composited;
  const std::vector<Result> results = in_pipeline(kind, 3, 2);
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_TRUE(same_bytes(results[i].picture, expected[i].picture)) << "frame " << i;
    EXPECT_GT(results[i].statistics.shaded, 0U);
  }
}

TEST(FrameInSteps, StopsWhenAskedTo) {
  KindOfPicture kind{"stopped", random_scene(4), {}};
  parallel::Progress progress;
  progress.request_stop();
  for (const int ranks : {1, 3})
    EXPECT_THROW(in_pipeline(kind, ranks, 2, &progress), parallel::Interrupted);
}

TEST(FrameInSteps, OnlyStrategiesThatKeepFramesApartHaveThem) {
  RenderOptions options;
  for (const Strategy& strategy : strategies()) {
    options.strategy = strategy.name;
    EXPECT_EQ(Renderer::has_steps(options, 2), options.strategy == "sort-last") << strategy.name;
  }
  options.strategy = "none";
  EXPECT_THROW(Renderer::has_steps(options, 2), std::invalid_argument);
}

}  // namespace
}  // namespace delray::raster
