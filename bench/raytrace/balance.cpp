// How even every schedule shares out the tiles of a ray-traced picture: counted rays of the ranks
// of the simulated machine, largest over mean, with the messages that it takes and the time that
// the machine predicts beside them. Static and interlaced, which never adapt, show what there is to
// gain. With `last frame` shares are a partition over what the tiles cost in the frame before.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/ratio.h"
#include "comm/simulated.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

using namespace delray;

namespace {

struct Case {
  std::string schedule, partition;
};

raytrace::Statistics simulated(const raytrace::Tracer& tracer, const scenes::Camera& camera,
                               const raytrace::RenderOptions& options, int ranks) {
  raytrace::Statistics statistics;
  // All ranks on one thread.
  parallel::Arena(1).execute([&] {
    comm::run_simulated(ranks, {}, 1, [&](comm::Communicator& communicator) {
      raytrace::Renderer renderer(tracer);
      for (int frame = options.partition.empty() ? 1 : 0; frame < 2; ++frame) {
        raytrace::Result result = renderer.render(communicator, camera, options);
        if (communicator.rank() == 0) statistics = std::move(result.statistics);
      }
    });
  });
  return statistics;
}

// Seconds of the simulated machine from the first task to the last.
double seconds_of(const raytrace::Statistics& statistics) {
  double begin = 1e300, end = 0;
  for (const raytrace::RankStatistics& rank : statistics.ranks) {
    for (const loadbalance::Interval& interval : rank.timeline) {
      begin = std::min(begin, interval.begin);
      end = std::max(end, interval.end);
    }
  }
  return std::max(0.0, end - begin);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("balance of the ray tracer's schedules");
  std::string name = "gen:corner";
  std::vector<int> ranks = {8};
  raytrace::RenderOptions options;
  std::vector<int> tiles = {raytrace::tile_side(options)};
  program.add_option("SCENE", name);
  program.add_option("--ranks", ranks)->delimiter(',');
  program.add_option("--tile", tiles, "sides in pixels")->delimiter(',');
  program.add_option("--width", options.width);
  program.add_option("--height", options.height);
  program.add_option("--spp", options.samples);
  program.add_option("--depth", options.trace.depth);
  std::vector<std::string> only;
  program.add_option("--schedule", only, "these, without shares (default: all)")->delimiter(',');
  bool each = false;
  program.add_flag("--each", each, "what every rank did, too: rays and tiles");
  CLI11_PARSE(program, argc, argv);

  std::vector<std::string> warnings;
  scenes::Scene scene =
      name.starts_with("gen:") ? scenes::generate(name) : scenes::load(name, warnings);
  const scenes::Camera camera =
      scene.cameras.empty() ? scenes::camera_around(scene, "default", 16.0F / 9) : scene.cameras[0];
  scenes::complete(scene, camera);
  const raytrace::Tracer tracer = raytrace::make_tracer(scene);
  std::vector<Case> cases;
  for (const std::string& schedule : only) cases.push_back({schedule, ""});
  if (only.empty()) {
    for (const loadbalance::Schedule& schedule : loadbalance::schedules())
      cases.push_back({schedule.name, ""});
    for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners())
      cases.push_back({"static", partitioner.name});
    cases.push_back({"stealing", "mahd"});
    cases.push_back({"neighbour-stealing", "mahd"});
  }
  std::printf("%s, %d x %d; counted on the simulated machine\n", name.c_str(), options.width,
              options.height);
  std::printf("%5s %5s %-20s %-13s %9s %9s %9s %9s %9s %10s\n", "ranks", "tile", "schedule",
              "last frame", "max/mean", "messages", "requests", "steals", "KiB", "seconds");
  for (const int n : ranks) {
    for (const int tile : tiles) {
      options.tile = tile;
      for (const Case& c : cases) {
        options.schedule = c.schedule;
        options.partition = c.partition;
        options.keep_factor = 1;
        const raytrace::Statistics s = simulated(tracer, camera, options, n);
        std::uint64_t messages = 0, requests = 0, steals = 0, bytes = 0;
        for (const raytrace::RankStatistics& rank : s.ranks) {
          messages += rank.messages;
          requests += rank.requests;
          steals += rank.steals;
          bytes += rank.bytes_sent;
        }
        std::printf("%5d %5d %-20s %-13s %9.3f %9llu %9llu %9llu %9.0f %10.4f\n", n, tile,
                    c.schedule.c_str(), c.partition.empty() ? "-" : c.partition.c_str(),
                    s.imbalance_rays, static_cast<unsigned long long>(messages),
                    static_cast<unsigned long long>(requests),
                    static_cast<unsigned long long>(steals), static_cast<double>(bytes) / 1024,
                    seconds_of(s));
        bench::report_ratio(name + ", " + std::to_string(n) + " ranks, tiles of " +
                                std::to_string(tile) + ", " + c.schedule +
                                (c.partition.empty() ? "" : " over " + c.partition),
                            s.imbalance_rays);
        for (const raytrace::RankStatistics& rank : s.ranks) {
          if (!each) break;
          std::printf("      rays %9llu tiles %5llu idle %.4f\n",
                      static_cast<unsigned long long>(rank.rays.primary + rank.rays.shadow +
                                                      rank.rays.secondary),
                      static_cast<unsigned long long>(rank.tasks), rank.idle);
        }
        std::fflush(stdout);
      }
    }
  }
}
