// What sort-first remembers from one frame of an animation to the next.
#include <gtest/gtest.h>

#include <cstring>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "loadbalance/balance.h"
#include "parallel/arena.h"
#include "raster/distribute/group_traffic.h"
#include "raster/render.h"
#include "scenes/camera_path.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

RenderOptions sort_first_options() {
  RenderOptions options;
  options.width = 120;
  options.height = 90;
  options.strategy = "sort-first";
  return options;
}

// The statistics of all frames; the pictures are those of frames on their own.
std::vector<Statistics> animated(const scenes::Scene& scene,
                                 std::span<const scenes::Camera> cameras,
                                 const RenderOptions& options, int ranks) {
  std::vector<Picture> expected;
  RenderOptions alone = options;
  alone.strategy = "sort-last";
  comm::run_threads(1, 2, [&](comm::Communicator& communicator) {
    for (const scenes::Camera& camera : cameras)
      expected.push_back(render(communicator, scene, camera, alone).picture);
  });
  std::vector<Statistics> statistics;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      Result result = renderer.render(communicator, cameras[i], options);
      if (communicator.rank() != 0) continue;
      const auto& picture = std::get<image::Image8>(result.picture);
      EXPECT_EQ(
          std::memcmp(picture.colour.data(), std::get<image::Image8>(expected[i]).colour.data(),
                      picture.pixels() * sizeof(image::Rgba8)),
          0)
          << "frame " << i;
      statistics.push_back(std::move(result.statistics));
      renderer.recycle(std::move(result.picture));
    }
  });
  return statistics;
}

TEST(SortFirst, WhatIsThereDoesNotTravelAgain) {
  const scenes::Scene scene = scenes::generate("gen:terrain:20000");
  const std::vector<scenes::Camera> still(3, scene.cameras[0]);
  for (const Travel travel : {Travel::geometry, Travel::numbers}) {
    RenderOptions options = sort_first_options();
    options.travel = travel;
    const std::vector<Statistics> frames = animated(scene, still, options, 4);
    EXPECT_GT(frames[0].triangles_travelled, 2000U);
    EXPECT_EQ(frames[1].triangles_travelled, 0U);
    EXPECT_EQ(frames[2].triangles_travelled, 0U);
  }
}

TEST(SortFirst, OnlyWhatEntersARegionTravels) {
  const scenes::Scene scene = scenes::generate("gen:city:20000");
  const std::vector<scenes::Camera> around = scenes::turntable(scene.cameras[0], 120);
  const auto first = std::span(around).first(12);
  for (const int ranks : {2, 5}) {
    const std::vector<Statistics> frames = animated(scene, first, sort_first_options(), ranks);
    std::uint64_t deferred = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) deferred += frames[i].triangles_travelled;
    EXPECT_GT(deferred, 0U);
    EXPECT_LT(deferred / (frames.size() - 1), frames[0].triangles_travelled / 3);
  }
}

TEST(SortFirst, WhatWasNotNeededForLongIsForgottenAndSentAgain) {
  const scenes::Scene scene = scenes::generate("gen:terrain:20000");
  const scenes::Camera there = scene.cameras[0];
  scenes::Camera elsewhere = there;
  elsewhere.eye = -there.eye;
  elsewhere.at = elsewhere.eye * 2.0F;  // nothing is seen
  RenderOptions options = sort_first_options();
  options.keep_factor = 1e9;  // nothing changes but what is seen
  // Frames in which nothing moves do not count.
  const auto turning = [&](std::size_t frames) {
    std::vector<scenes::Camera> cameras(frames, elsewhere);
    for (std::size_t i = 0; i < frames; ++i) cameras[i].eye *= 1 + 0.01F * static_cast<float>(i);
    cameras.front() = cameras.back() = there;
    return cameras;
  };
  const std::vector<scenes::Camera> soon = turning(GroupTraffic::kFramesKept);
  const std::vector<Statistics> back_soon = animated(scene, soon, options, 3);
  EXPECT_GT(back_soon.front().triangles_travelled, 0U);
  EXPECT_EQ(back_soon.back().triangles_travelled, 0U);
  const std::vector<scenes::Camera> late = turning(GroupTraffic::kFramesKept + 2);
  const std::vector<Statistics> back_late = animated(scene, late, options, 3);
  EXPECT_EQ(back_late.back().triangles_travelled, back_late.front().triangles_travelled);
}

TEST(SortFirst, MeasuredCostsAndMoreRegionsThanRanksGiveTheSamePictures) {
  const scenes::Scene scene = random_scene(11);
  const std::vector<scenes::Camera> around = scenes::turntable(random_scene_camera(), 7);
  for (const CostSource costs : {CostSource::model, CostSource::measured}) {
    for (const int regions : {1, 3}) {
      for (const double factor : {1.0, 1.5}) {
        RenderOptions options = sort_first_options();
        options.costs = costs;
        options.regions_per_rank = regions;
        options.keep_factor = factor;
        options.supersampling = regions == 3 ? 2 : 1;
        options.report_partition = true;
        for (const Statistics& frame : animated(scene, around, options, 4)) {
          ASSERT_TRUE(frame.partition.has_value());
          EXPECT_GE(frame.partition->predicted, 1);
          EXPECT_GE(frame.partition->over_share, 1);
          EXPECT_GE(frame.partition->overlap, 1);
        }
      }
    }
  }
}

// One of the ranks takes ten times as long for everything.
TEST(SortFirst, RanksThatAreDoneStealBlocksFromASlowOne) {
  const scenes::Scene scene = scenes::generate("gen:terrain:5000");
  RenderOptions options = sort_first_options();
  options.block = 4;
  options.partition = "interlaced";  // many blocks for each
  comm::Network network;             // a block takes many times as long as a message
  for (double& seconds : network.seconds_per_work) seconds *= 50;
  comm::SimulationOptions slow;
  slow.slowness = {1, 1, 10, 1};
  double without = 0;
  for (const char* schedule : {"static", "stealing", "neighbour-stealing"}) {
    options.schedule = schedule;
    std::vector<RankStatistics> ranks;
    const std::vector<double> ends = parallel::Arena(1).execute([&] {
      return comm::run_simulated(
          4, network, 1,
          [&](comm::Communicator& communicator) {
            Result result = render(communicator, scene, scene.cameras[0], options);
            if (communicator.rank() == 0) ranks = std::move(result.statistics.ranks);
          },
          slow);
    });
    const double end = *std::max_element(ends.begin(), ends.end());
    std::uint64_t stolen = 0, blocks = 0;
    for (const RankStatistics& rank : ranks) {
      stolen += rank.blocks_stolen;
      blocks += rank.tasks;
    }
    EXPECT_EQ(blocks, 30U * 23) << schedule;
    if (options.schedule == "static") {
      EXPECT_EQ(stolen, 0U);
      without = end;
    } else {
      EXPECT_GT(stolen, 10U) << schedule;
      // Who asks its neighbours only, before it runs dry, may be the slow one itself.
      EXPECT_LT(end, 0.25 * without) << schedule;
    }
  }
}

// Told without ranks: only where their shares meet are primitives grouped in another way.
TEST(SortFirst, CostsForetellWhatRanksCutBy) {
  const scenes::Scene scene = scenes::generate("gen:terrain:5000");
  RenderOptions options = sort_first_options();
  options.report_partition = true;
  constexpr int kRanks = 3;
  Statistics statistics;
  comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
    Result result = render(communicator, scene, scene.cameras[0], options);
    if (communicator.rank() == 0) statistics = std::move(result.statistics);
  });
  ASSERT_TRUE(statistics.partition);
  const PartitionStatistics& told = *statistics.partition;
  const loadbalance::Costs costs = Renderer(scene).costs(kRanks, scene.cameras[0], options);
  const loadbalance::PartitionReport foretold =
      loadbalance::report(*loadbalance::find_partitioner(options.partition), costs, kRanks);
  EXPECT_EQ(told.partition.frame, costs.frame);
  EXPECT_EQ(told.partition.regions.size(), foretold.partition.regions.size());
  EXPECT_NEAR(told.over_share, foretold.balance.over_share, 0.03 * told.over_share);
  EXPECT_NEAR(told.overlap, foretold.balance.overlap, 0.03 * told.overlap);
  ASSERT_EQ(told.loads.size(), static_cast<std::size_t>(kRanks));
  for (int rank = 0; rank < kRanks; ++rank)
    EXPECT_NEAR(told.loads[rank], foretold.balance.loads[rank], 0.05 * told.loads[rank]);
}

TEST(SortFirst, ARendererMayServeOneNumberOfRanksAfterAnother) {
  const scenes::Scene scene = random_scene(12);
  const RenderOptions options = sort_first_options();
  Picture pictures[2];
  std::vector<Renderer> renderers;
  for (int i = 0; i < 4; ++i) renderers.emplace_back(scene);
  for (const int ranks : {3, 2, 3, 4, 2, 3}) {
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      Result result =
          renderers[communicator.rank()].render(communicator, random_scene_camera(), options);
      if (communicator.rank() == 0) {
        pictures[0] = std::move(pictures[1]);
        pictures[1] = std::move(result.picture);
        const auto& last = std::get<image::Image8>(pictures[0]);
        const auto& now = std::get<image::Image8>(pictures[1]);
        if (last.width > 0) {
          EXPECT_EQ(std::memcmp(last.colour.data(), now.colour.data(), now.pixels() * 4), 0);
        }
      }
    });
  }
}

}  // namespace
}  // namespace delray::raster
