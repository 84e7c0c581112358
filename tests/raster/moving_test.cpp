// Renderers that follow a scene: the pictures of each pose, and messages of what moved alone.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "comm/recording.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "scenes/pose.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

const std::vector<double> kTimes = {0.0, 0.3, 0.3, 0.9, 1.6};

struct Frames {
  std::vector<Picture> pictures;
  std::vector<std::uint64_t> bytes, triangles;  // that travelled to draw them
};

// All frames by ranks that have a scene each, as processes do.
Frames frames(const char* name, const RenderOptions& options, int ranks) {
  Frames result;
  std::vector<std::vector<std::uint64_t>> sent(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    scenes::Scene scene = scenes::generate(name);
    Renderer renderer(scene);
    for (const double t : kTimes) {
      renderer.follow(scenes::pose(scene, {0, t}));
      std::vector<comm::Event> events;
      comm::Recording recording(communicator, events);
      Result one = renderer.render(recording, scene.cameras[0], options);
      std::uint64_t& bytes = sent[static_cast<std::size_t>(communicator.rank())].emplace_back(0);
      for (const comm::Event& event : events) {
        if (event.kind == comm::Event::Kind::send && event.phase == comm::Phase::redistribute)
          bytes += event.amount;
      }
      if (communicator.rank() != 0) continue;
      result.pictures.push_back(std::move(one.picture));
      result.triangles.push_back(one.statistics.triangles_travelled);
    }
  });
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    result.bytes.push_back(0);
    for (const auto& rank : sent) result.bytes[i] += rank[i];
  }
  return result;
}

RenderOptions way(const std::string& name) {
  RenderOptions options;
  options.width = 96;
  options.height = 64;
  const std::size_t slash = name.find('/');
  options.strategy = name.substr(0, slash);
  const std::string rest = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (rest == "numbers") options.travel = Travel::numbers;
  if (rest == "stealing") options.schedule = "stealing";
  if (rest == "measured") options.costs = CostSource::measured;
  if (rest == "by-cell") options.blend = Blend::by_cell;
  return options;
}

TEST(MovingScenes, OnePictureOfEachPoseHoweverTheWorkIsShared) {
  for (const char* name : {"gen:machine:6400", "gen:cloth:600", "gen:arm:600"}) {
    std::vector<Picture> alone;
    for (const double t : kTimes) {
      scenes::Scene scene = scenes::generate(name);
      pose(scene, {0, t});
      comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
        alone.push_back(render(communicator, scene, scene.cameras[0], way("sort-last")).picture);
      });
    }
    EXPECT_FALSE(same_bytes(alone[0], alone[1])) << name;
    for (const char* how : {"sort-last", "sort-first", "sort-first/numbers", "sort-first/stealing",
                            "sort-first/measured", "sort-middle", "hybrid", "hybrid/numbers"}) {
      for (const int ranks : {1, 3}) {
        const Frames moving = frames(name, way(how), ranks);
        for (std::size_t i = 0; i < kTimes.size(); ++i)
          EXPECT_TRUE(same_bytes(moving.pictures[i], alone[i])) << name << how << ranks << i;
      }
    }
  }
}

TEST(MovingScenes, SortFirstSendsOnlyWhatMoved) {
  const Frames machine = frames("gen:machine:25600", way("sort-first"), 3);
  EXPECT_GT(machine.triangles[0], 2000U);
  for (std::size_t i = 1; i < kTimes.size(); ++i) {
    // But for parts that come into a region that they were not in.
    EXPECT_LT(machine.triangles[i], machine.triangles[0] / 4) << i;
    EXPECT_LT(machine.bytes[i], machine.bytes[0] / 2) << i;
  }
  EXPECT_EQ(machine.triangles[2], 0U);  // nothing moved
  const Frames cloth = frames("gen:cloth:2000", way("sort-first"), 3);
  EXPECT_GT(cloth.triangles[1], 0U);  // the flag is another one
  EXPECT_EQ(cloth.triangles[2], 0U);
}

}  // namespace
}  // namespace delray::raster
