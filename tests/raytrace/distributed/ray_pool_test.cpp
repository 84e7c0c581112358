// Rays that wait are stolen: one picture whoever traces them, and even loads.
#include "raytrace/distributed/ray_pool.h"

#include <gtest/gtest.h>

#include <iostream>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "tests/raytrace/shared_out.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

std::vector<const loadbalance::Schedule*> dividing() {
  std::vector<const loadbalance::Schedule*> result;
  for (const loadbalance::Schedule& schedule : loadbalance::schedules())
    if (schedule.divides) result.push_back(&schedule);
  return result;
}

Result simulated(const Tracer& tracer, const scenes::Camera& camera, const RenderOptions& options,
                 int ranks, const comm::Network& network = {}, std::uint64_t seed = 1) {
  Result result;
  comm::SimulationOptions simulation;
  simulation.stack_bytes = std::size_t{8} << 20;
  parallel::Arena(1).execute([&] {
    comm::run_simulated(
        ranks, network, seed,
        [&](comm::Communicator& communicator) {
          Result one = render(communicator, tracer, camera, options);
          if (communicator.rank() == 0) result = std::move(one);
        },
        simulation);
  });
  return result;
}

std::uint64_t rays_stolen(const Result& result) {
  std::uint64_t sum = 0;
  for (const RankStatistics& rank : result.statistics.ranks) sum += rank.rays_stolen;
  return sum;
}

// A single tile for every rank or fewer: nothing but waiting rays can move.
TEST(RayPool, GivesOnePictureForScenesIntegratorsAndRanks) {
  for (const char* name : {"gen:corner:4000", "gen:cornell", "gen:spheres:4000"}) {
    const scenes::Scene scene = completed(name);
    const Tracer tracer = make_tracer(scene);
    for (const char* integrator : {"direct", "whitted", "path", "ao"}) {
      RenderOptions options = small(90, 62);
      options.integrator = integrator;
      options.samples = 2;
      options.trace.depth = 4;
      options.tile = 64;
      const Result alone = simulated(tracer, scene.cameras[0], options, 1);
      for (const loadbalance::Schedule* schedule : dividing()) {
        options.schedule = schedule->name;
        std::uint64_t stolen = 0;
        for (const int ranks : {1, 2, 3, 8}) {
          SCOPED_TRACE(std::string(name) + ' ' + integrator + ' ' + schedule->name + ' ' +
                       std::to_string(ranks));
          const Result result = simulated(tracer, scene.cameras[0], options, ranks);
          EXPECT_EQ(different(alone, result), 0U);
          EXPECT_EQ(alone.statistics.rays, result.statistics.rays);
          std::uint64_t of_tiles = 0;
          for (const TileCost& tile : result.tile_costs) of_tiles += tile.rays;
          EXPECT_EQ(of_tiles, alone.statistics.rays.sent());
          stolen += rays_stolen(result);
        }
        EXPECT_GT(stolen, 1000U) << name << ' ' << integrator << ' ' << schedule->name;
      }
    }
  }
}

// Messages in any order, rays that are stolen again from who has stolen them.
TEST(RayPool, GivesOnePictureInEveryOrderOfMessages) {
  const scenes::Scene scene = completed("gen:corner:4000");
  const Tracer tracer = make_tracer(scene);
  RenderOptions options = small(64, 48);
  options.integrator = "path";
  options.samples = 3;
  options.tile = 64;
  const Result alone = simulated(tracer, scene.cameras[0], options, 1);
  for (const loadbalance::Schedule* schedule : dividing()) {
    options.schedule = schedule->name;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      SCOPED_TRACE(std::string(schedule->name) + ", seed " + std::to_string(seed));
      comm::Network network = comm::any_order();
      network.jitter = seed % 2 == 0 ? 1e-4 : 1e-2;
      network.seconds_per_work[static_cast<int>(comm::Work::rays)] = 1e-6;
      const Result result = simulated(tracer, scene.cameras[0], options,
                                      2 + static_cast<int>(seed % 8), network, seed);
      EXPECT_EQ(different(alone, result), 0U);
      EXPECT_EQ(alone.statistics.rays, result.statistics.rays);
    }
  }
}

// Ranks that are threads, more of them than cores, with threads of their own.
TEST(RayPool, GivesOnePictureOnThreads) {
  const parallel::AllowThreads allowed(12);
  const scenes::Scene scene = completed("gen:corner:4000");
  const Tracer tracer = make_tracer(scene);
  for (const char* integrator : {"whitted", "path"}) {
    for (const Primary primary : {Primary::trace, Primary::raster_always}) {
      RenderOptions options = small(75, 50);
      options.integrator = integrator;
      options.samples = 4;
      options.primary = primary;
      options.tile = 16;
      const Result alone = simulated(tracer, scene.cameras[0], options, 1);
      for (const loadbalance::Schedule* schedule : dividing()) {
        options.schedule = schedule->name;
        for (const int tile : {13, 16, 128}) {
          options.tile = tile;
          SCOPED_TRACE(std::string(integrator) + ' ' + schedule->name + ' ' + std::to_string(tile));
          Result result;
          comm::run_threads(3, 4, [&](comm::Communicator& communicator) {
            Result one = render(communicator, tracer, scene.cameras[0], options);
            if (communicator.rank() == 0) result = std::move(one);
          });
          EXPECT_EQ(different(alone, result), 0U);
          if (tile % 4 == 0) {
            EXPECT_EQ(alone.statistics.rays, result.statistics.rays);
          }
        }
      }
    }
  }
}

// Every ray costs alike on ranks with a core each, and one rank's consecutive tiles have most of
// them. Static shares leave that rank with several times the mean; stealing tiles leaves it with
// the one that it is at; stealing rays evens out to a few hundredths.
TEST(RayPool, EvensOutOneRankThatHasAllTheWork) {
  const scenes::Scene scene = completed("gen:corner:20000");
  const Tracer tracer = make_tracer(scene);
  for (const char* integrator : {"whitted", "path"}) {
    RenderOptions options = small(384, 288);
    options.integrator = integrator;
    options.samples = integrator == std::string("path") ? 4 : 1;
    options.tile = 96;  // 4 x 3 of them
    const auto imbalance_of = [&](const char* schedule) {
      options.schedule = schedule;
      const Result result = simulated(tracer, scene.cameras[0], options, 8);
      const double imbalance = result.statistics.imbalance_rays;
      std::cout << integrator << ' ' << schedule << ": " << imbalance << ", " << rays_stolen(result)
                << " rays stolen of " << result.statistics.rays.sent() << '\n';
      return imbalance;
    };
    EXPECT_GT(imbalance_of("static"), 1.5);
    EXPECT_GT(imbalance_of("stealing"), 1.5);
    for (const loadbalance::Schedule* schedule : dividing())
      EXPECT_LT(imbalance_of(schedule->name), 1.1);
  }
}

}  // namespace
}  // namespace delray::raytrace
