// The ray tracer's tiles handed out by every schedule: one picture, even work.
#include <gtest/gtest.h>

#include <cstring>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "scenes/camera_path.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

struct Corner {
  scenes::Scene scene;
  scenes::Camera camera;
  Tracer tracer;

  Corner() : scene(completed()), camera(scene.cameras[0]), tracer(make_tracer(scene)) {}
  static scenes::Scene completed() {
    scenes::Scene scene = scenes::generate("gen:corner:20000");
    scenes::complete(scene, scene.cameras[0]);
    return scene;
  }
};

const Corner& corner() {
  static const Corner corner;
  return corner;
}

void expect_same(const Result& a, const Result& b) {
  ASSERT_EQ(a.image.pixels(), b.image.pixels());
  EXPECT_EQ(std::memcmp(a.image.colour.data(), b.image.colour.data(),
                        a.image.pixels() * sizeof(image::RgbaF)),
            0);
  EXPECT_EQ(
      std::memcmp(a.image.depth.data(), b.image.depth.data(), a.image.pixels() * sizeof(float)), 0);
  EXPECT_EQ(a.statistics.rays, b.statistics.rays);
}

std::vector<Result> animated(const RenderOptions& options, int ranks, int threads, int frames) {
  std::vector<Result> results;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Renderer renderer(corner().tracer);
    for (int i = 0; i < frames; ++i) {
      Result result = renderer.render(communicator, corner().camera, options);
      if (communicator.rank() == 0) results.push_back(std::move(result));
    }
  });
  return results;
}

Result single(const RenderOptions& options, int ranks, int threads) {
  return std::move(animated(options, ranks, threads, 1).front());
}

TEST(Schedules, GiveOnePictureForEveryNumberOfRanksAndThreads) {
  const parallel::AllowThreads allowed(16);
  RenderOptions options = small(75, 50);
  options.tile = 16;
  options.trace.depth = 3;
  const Result alone = single(options, 1, 1);
  for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
    options.schedule = schedule.name;
    for (const int ranks : {1, 2, 3, 4, 8}) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(options.schedule + ' ' + std::to_string(ranks) + " x " +
                     std::to_string(threads));
        const Result result = single(options, ranks, threads);
        expect_same(alone, result);
        std::uint64_t tasks = 0, sent = 0, received = 0;
        ASSERT_EQ(result.statistics.ranks.size(), static_cast<std::size_t>(ranks));
        for (const RankStatistics& rank : result.statistics.ranks) {
          tasks += rank.tasks;
          sent += rank.bytes_sent;
          received += rank.bytes_received;
          std::uint64_t in_timeline = 0;
          for (const loadbalance::Interval& interval : rank.timeline) in_timeline += interval.tasks;
          EXPECT_EQ(in_timeline, rank.tasks);
        }
        EXPECT_EQ(tasks, 5U * 4U);
        EXPECT_EQ(sent, received);
      }
    }
  }
}

TEST(Schedules, GiveOnePictureForEverySizeOfTiles) {
  RenderOptions options = small(75, 50);
  const Result alone = single(options, 1, 1);
  options.schedule = "demand";
  for (const int tile : {16, 48, 64, 128}) {
    options.tile = tile;
    expect_same(alone, single(options, 3, 1));
  }
}

// Badouel's blocks of 3 x 3 pixels, Heirich's of one, and others that cut packets: these are traced
// whole, and every tile keeps its own pixels.
TEST(Schedules, GiveOnePictureWhereTilesCutPackets) {
  RenderOptions options = small(37, 22);
  const Result alone = single(options, 1, 1);
  const auto traced_for = [&](int tile) {
    std::uint64_t pixels = 0;  // of packets, once for each tile that they reach into
    for (int y = 0; y < options.height; y += tile) {
      for (int x = 0; x < options.width; x += tile) {
        const auto side = [tile](int from, int all) {
          const int last = std::min(from + tile, all);
          return std::min((last + 3) / 4 * 4, all) - from / 4 * 4;
        };
        pixels += static_cast<std::uint64_t>(side(x, options.width) * side(y, options.height));
      }
    }
    return pixels;
  };
  const std::uint64_t pixels = 37 * 22;
  options.schedule = "demand";
  for (const int tile : {1, 2, 3, 4, 5, 18, 20}) {
    SCOPED_TRACE(tile);
    options.tile = tile;
    const Result result = single(options, 3, 1);
    ASSERT_EQ(alone.image.pixels(), result.image.pixels());
    EXPECT_EQ(std::memcmp(alone.image.colour.data(), result.image.colour.data(),
                          pixels * sizeof(image::RgbaF)),
              0);
    EXPECT_EQ(
        std::memcmp(alone.image.depth.data(), result.image.depth.data(), pixels * sizeof(float)),
        0);
    EXPECT_EQ(result.statistics.rays.primary, traced_for(tile));
    EXPECT_EQ(result.statistics.rays.surplus, traced_for(tile) - pixels);
    if (tile % 4 == 0) {
      EXPECT_EQ(result.statistics.rays, alone.statistics.rays);
    }
  }
}

// Heirich: a static share is uneven however small the tiles are, if each is one pixel, too; dynamic
// ones are not. Of a corner of the picture that takes most rays.
TEST(Schedules, AreUnevenOrEvenWhateverTheSizeOfTiles) {
  const auto imbalance_of = [](const char* schedule, int tile) {
    RenderOptions options = small(48, 36);
    options.schedule = schedule;
    options.tile = tile;
    options.trace.depth = 4;
    double imbalance = 0;
    parallel::Arena(1).execute([&] {
      comm::run_simulated(8, {}, 1, [&](comm::Communicator& communicator) {
        const Result result = render(communicator, corner().tracer, corner().camera, options);
        if (communicator.rank() == 0) imbalance = result.statistics.imbalance_rays;
      });
    });
    return imbalance;
  };
  for (const int tile : {1, 4}) {
    EXPECT_GT(imbalance_of("static", tile), 1.3) << tile;
    EXPECT_LT(imbalance_of("half-stealing", tile), imbalance_of("static", tile)) << tile;
  }
}

// Counted rays on eight ranks of the simulated machine, each with a core of its own: what the
// number of cores here has no influence on.
Statistics simulated(const std::string& schedule) {
  Statistics statistics;
  RenderOptions options = small(720, 540);
  options.schedule = schedule;
  options.tile = 16;
  options.trace.depth = 4;
  parallel::Arena arena(1);
  arena.execute([&] {
    comm::run_simulated(8, {}, 1, [&](comm::Communicator& communicator) {
      Result result = render(communicator, corner().tracer, corner().camera, options);
      if (communicator.rank() == 0) statistics = std::move(result.statistics);
    });
  });
  return statistics;
}

TEST(Schedules, ThatAdaptEvenOutAnExpensiveCorner) {
  EXPECT_GT(simulated("static").imbalance_rays, 1.5);  // there is something to even out
  for (const char* name : {"demand", "guided", "stealing", "neighbour-stealing"}) {
    EXPECT_LE(simulated(name).imbalance_rays, 1.1) << name;
  }
}

TEST(Schedules, BeginWithSharesThatTheLastFrameEvensOut) {
  RenderOptions options = small(240, 160);
  options.tile = 16;
  options.schedule = "static";
  options.keep_factor = 1;
  const Result plain = single(options, 1, 1);
  for (const char* name : {"mahd", "kd-split", "graph"}) {
    SCOPED_TRACE(name);
    options.partition = name;
    const std::vector<Result> results = animated(options, 4, 1, 2);
    for (const Result& result : results) expect_same(plain, result);
    ASSERT_TRUE(results[1].statistics.partition);
    EXPECT_FALSE(results[0].statistics.partition->measured);
    EXPECT_TRUE(results[1].statistics.partition->measured);
    EXPECT_LT(results[1].statistics.partition->predicted, 1.2);
    EXPECT_LT(results[1].statistics.imbalance_rays, results[0].statistics.imbalance_rays);
  }
}

TEST(Schedules, KeepSharesWhileTheyAreEvenEnough) {
  RenderOptions options = small(120, 80);
  options.tile = 16;
  options.schedule = "stealing";
  options.partition = "mahd";
  options.costs = CostSource::seconds;
  options.keep_factor = 1000;
  const std::vector<Result> results = animated(options, 3, 1, 3);
  EXPECT_FALSE(results[0].statistics.partition->kept);
  EXPECT_TRUE(results[1].statistics.partition->kept);
  EXPECT_TRUE(results[2].statistics.partition->kept);
}

}  // namespace
}  // namespace delray::raytrace
