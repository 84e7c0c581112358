// What following a scene costs beside building anew. gen:machine: its instances move, and the top
// level is built; gen:cloth: its vertices move, and the structure is refitted or built anew, in
// turns. Printed are the medians.
//
//   raytrace_moving [--machine N] [--cloth N] [--turns N] [--threads N]
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "parallel/arena.h"
#include "raytrace/tracer.h"
#include "scenes/generate.h"
#include "scenes/pose.h"

namespace {

using namespace delray;

struct Arguments {
  std::uint64_t machine = 1'000'000, cloth = 1'000'000;
  int turns = 9, threads = 2;
};

raytrace::Tracer tracer_of(const scenes::Scene& scene, double refit_limit) {
  raytrace::BuildOptions options;
  options.refit_limit = refit_limit;
  return raytrace::make_tracer(scene, options);
}

void time_machine(const Arguments& arguments) {
  scenes::Scene scene = scenes::generate("gen:machine:" + std::to_string(arguments.machine));
  raytrace::Tracer tracer = tracer_of(scene, 1.4);
  std::vector<double> top, all, pose;
  for (int turn = 0; turn < arguments.turns; ++turn) {
    scenes::Movement movement;
    pose.push_back(bench::seconds_of([&] {
      movement = scenes::pose(scene, {0, 0.03 + 0.07 * turn});
      return 0;
    }));
    const raytrace::FollowCounts counts = raytrace::follow(tracer, scene, movement);
    top.push_back(counts.top_seconds);
    all.push_back(counts.seconds);
  }
  std::printf(
      "%zu instances, of which %zu move: pose %.2f ms, top level %.2f ms, following %.2f ms; "
      "building all %.1f ms\n",
      scene.instances.size(), scene.animations.instances.size(), 1e3 * bench::median(pose),
      1e3 * bench::median(top), 1e3 * bench::median(all), 1e3 * tracer.build_seconds);
  bench::report_ratio("top level of moving instances over 2 ms", bench::median(top) / 2e-3,
                      bench::Better::lower, 1);
}

void time_cloth(const Arguments& arguments) {
  scenes::Scene scene = scenes::generate("gen:cloth:" + std::to_string(arguments.cloth));
  raytrace::Tracer refitted = tracer_of(scene, 1e9), built = tracer_of(scene, 0);
  std::vector<double> refit, build, ratios, pose;
  for (int turn = 0; turn < arguments.turns; ++turn) {
    scenes::Movement movement;
    pose.push_back(bench::seconds_of([&] {
      movement = scenes::pose(scene, {0, 0.03 + 0.07 * turn});
      return 0;
    }));
    refit.push_back(raytrace::follow(refitted, scene, movement).refit_seconds);
    build.push_back(raytrace::follow(built, scene, movement).build_seconds);
    ratios.push_back(refit.back() / build.back());
  }
  const double ratio = bench::median(ratios);
  std::printf(
      "%llu triangles that bend: pose %.1f ms, refit %.1f ms, build anew %.1f ms: ratio %.3f "
      "(bar 0.2)\n",
      static_cast<unsigned long long>(scenes::triangle_count(scene)), 1e3 * bench::median(pose),
      1e3 * bench::median(refit), 1e3 * bench::median(build), ratio);
  bench::report_ratio("refit over build, " + bench::thread_count(arguments.threads), ratio,
                      bench::Better::lower, 0.2);
}

}  // namespace

int main(int argc, char** argv) try {
  Arguments arguments;
  CLI::App app("Following scenes that move");
  app.add_option("--machine", arguments.machine, "Triangles of gen:machine");
  app.add_option("--cloth", arguments.cloth, "Triangles of gen:cloth");
  app.add_option("--turns", arguments.turns, "Poses");
  app.add_option("--threads", arguments.threads, "Threads");
  CLI11_PARSE(app, argc, argv);
  const parallel::AllowThreads allowed(arguments.threads);
  parallel::Arena arena(arguments.threads);
  arena.execute([&] {
    time_machine(arguments);
    time_cloth(arguments);
  });
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
