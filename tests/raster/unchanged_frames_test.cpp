// What ranks tell each other of a frame in which nothing has changed.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <random>

#include "comm/recording.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

using BytesByPhase = std::map<comm::Phase, std::uint64_t>;

// What all ranks send in each of the frames; the picture stays the same.
std::vector<BytesByPhase> sent(const scenes::Scene& scene, const RenderOptions& options, int ranks,
                               int frames) {
  std::vector<std::vector<BytesByPhase>> by_rank(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    Picture first;
    for (int frame = 0; frame < frames; ++frame) {
      std::vector<comm::Event> events;
      comm::Recording recording(communicator, events);
      Result result = renderer.render(recording, scene.cameras[0], options);
      BytesByPhase& bytes = by_rank[static_cast<std::size_t>(communicator.rank())].emplace_back();
      for (const comm::Event& event : events)
        if (event.kind == comm::Event::Kind::send) bytes[event.phase] += event.amount;
      if (communicator.rank() != 0) continue;
      if (frame == 0)
        first = std::move(result.picture);
      else
        EXPECT_TRUE(same_bytes(result.picture, first));
    }
  });
  std::vector<BytesByPhase> sums(static_cast<std::size_t>(frames));
  for (const auto& rank : by_rank) {
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (const auto& [phase, bytes] : rank[i]) sums[i][phase] += bytes;
  }
  return sums;
}

// Ranks ask once whether anything has changed for anybody: an all_reduce of 24 bytes each, and
// nothing else but pixels and, where these are composited, the depths of blocks.
TEST(UnchangedFrames, TellNothingButThatTheyAreUnchanged) {
  const scenes::Scene scene = scenes::generate("gen:city:2000");
  RenderOptions options;
  options.width = 320;
  options.height = 200;
  for (const std::string way :
       {"sort-first", "sort-first/numbers", "sort-first/static", "sort-middle", "hybrid"}) {
    for (const unsigned ranks : {2U, 4U, 16U}) {
      options.strategy = way.substr(0, way.find('/'));
      options.travel = way == "sort-first/numbers" ? Travel::numbers : Travel::geometry;
      options.schedule = way == "sort-first/static" ? "static" : "";
      options.regions_per_rank = ranks == 4 ? 3 : 1;
      const std::vector<BytesByPhase> frames = sent(scene, options, static_cast<int>(ranks), 4);
      const std::uint64_t question = std::uint64_t{24} * ranks * std::bit_width(ranks - 1);
      // Tiles of 32 blocks, 8 bytes each, and the box of tiles that show anything.
      const std::uint64_t covers = question / 24 * (5 * 4 * 32 * 8 + 16);
      for (std::size_t i = 0; i < frames.size(); ++i) {
        std::uint64_t bytes = 0;
        for (const auto& [phase, amount] : frames[i])
          if (phase != comm::Phase::gather && phase != comm::Phase::compose) bytes += amount;
        if (i == 0)
          EXPECT_GT(bytes, 20 * question) << way << ", " << ranks;
        else
          EXPECT_EQ(bytes, way == "hybrid" ? question + covers : question) << way << ", " << ranks;
      }
    }
  }
}

// Whatever ranks remember of frames before, in whichever company, pictures are those of frames
// alone.
TEST(UnchangedFrames, LeaveNoTraceInOtherFrames) {
  const scenes::Scene scene = random_scene(3);
  std::vector<scenes::Camera> cameras(3, random_scene_camera());
  cameras[1].eye.x += 0.7F;
  cameras[2].at = cameras[2].eye * 2.0F;  // nothing is seen
  std::vector<RenderOptions> ways(5);
  for (RenderOptions& way : ways) {
    way.width = 53;
    way.height = 39;
    way.strategy = "sort-first";
  }
  ways[1].strategy = ways[2].strategy = "hybrid";
  ways[2].travel = Travel::numbers;
  ways[3].strategy = "sort-middle";
  ways[4].partition = "kd-split";
  ways[4].report_partition = true;
  std::vector<Picture> expected;
  comm::run_threads(1, 1, [&](comm::Communicator& alone) {
    for (const scenes::Camera& camera : cameras)
      expected.push_back(render(alone, scene, camera, ways[0]).picture);
  });
  comm::run_threads(5, 1, [&](comm::Communicator& all) {
    Renderer renderer(scene);
    std::mt19937 random(4);  // the same on all ranks
    for (int turn = 0; turn < 60; ++turn) {
      const unsigned company = random() % 3, first = random() % 3, second = random() % 3;
      const RenderOptions& way = ways[random() % ways.size()];
      const bool is_second = company == 1 ? all.rank() % 2 == 1 : company == 2 && all.rank() > 2;
      const std::unique_ptr<comm::Communicator> some = all.split(is_second ? 1 : 0, 0);
      const unsigned camera = is_second ? second : first;
      for (int repeat = 0; repeat < 2; ++repeat) {
        const Result result = renderer.render(*some, cameras[camera], way);
        if (some->rank() != 0) continue;
        ASSERT_TRUE(same_bytes(result.picture, expected[camera]))
            << "turn " << turn << ", " << way.strategy << ", camera " << camera;
        EXPECT_EQ(result.statistics.partition.has_value(), way.report_partition);
      }
    }
  });
}

}  // namespace
}  // namespace delray::raster
