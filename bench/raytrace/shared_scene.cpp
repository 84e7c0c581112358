// What it costs that no rank has the whole scene: frames of every distribution beside those of
// ranks that have it, in turns, each a rank's thread. Printed are the median of the frame times, of
// their ratio to `replicated` in the same turn, by the clock and in processor time of all ranks,
// which a busy machine changes little, and what was counted in the last frame. `object` comes with
// a cache for everything and with one for a quarter of the scene.
//
// Under mpirun the ranks are its processes, and processor time is that of the first.
#include <time.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "raytrace/shared_scene.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

namespace {

using namespace delray;

struct Arguments {
  std::vector<std::string> scenes = {"gen:terrain:2000000"}, integrators = {"direct"};
  std::vector<std::string> only;
  int width = 1280, height = 720, ranks = 2, threads = 1, turns = 7, warm = 3;
  bool turntable = false;
  bool random = false;
};

struct Variant {
  std::string name, distribution;
  double cache = 0.0;  // share of the scene; 0: the default
  // Limits of the ratio to `replicated`: at rest, on a turntable, of `path` at rest; 0: none.
  double at_rest = 0.0, turning = 0.0, path = 0.0;
};

const std::vector<Variant> kVariants = {{"replicated", "replicated"},
                                        {"object, all", "object", 2.0, 1.15, 1.3, 1.2},
                                        {"object, 1/4", "object", 0.25, 5, 6, 8},
                                        {"ray", "ray", 0.0, 2.5, 3, 5},
                                        {"hybrid", "hybrid", 0.0, 2.5, 3, 5},
                                        {"ring", "ring", 0.0, 6, 7, 10}};

// Of all threads of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// What frames of a variant took.
struct Times {
  std::vector<double> seconds, ratios, processor;
};

// A rank's side of a variant.
struct Side {
  std::optional<raytrace::SharedScene> scene;
  std::optional<raytrace::Renderer> renderer;
};

void print(const Variant& variant, const Times& times, const raytrace::Statistics& last) {
  std::printf("  %-12s %8.1f ms  ratio %6.2f, of processor time %6.2f ", variant.name.c_str(),
              1e3 * bench::median(times.seconds), bench::median(times.ratios),
              bench::median(times.processor));
  for (const raytrace::RankStatistics& rank : last.ranks) {
    std::printf(
        " | busy %.1f rays %.0fk answers %.0fk tests %.0fk fetched %llu dropped %llu %.1f MB",
        1e3 * rank.busy, 1e-3 * static_cast<double>(rank.rays_sent),
        1e-3 * static_cast<double>(rank.answers_sent), 1e-3 * static_cast<double>(rank.tests),
        static_cast<unsigned long long>(rank.clusters_fetched),
        static_cast<unsigned long long>(rank.clusters_dropped),
        1e-6 * static_cast<double>(rank.bytes_sent));
  }
  std::printf("\n");
  std::fflush(stdout);
}

// `world`: of MPI; null: ranks are threads.
void compare(const std::string& name, const std::string& integrator, const Arguments& arguments,
             comm::Communicator* world) {
  std::vector<std::string> warnings;
  scenes::Scene scene =
      scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  const float aspect = static_cast<float>(arguments.width) / static_cast<float>(arguments.height);
  const scenes::Camera camera = !scene.cameras.empty()
                                    ? scene.cameras.front()
                                    : scenes::camera_around(scene, "default", aspect);
  scenes::complete(scene, camera);
  raytrace::RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  options.integrator = integrator;
  constexpr int kFrames = 72;  // of a turn of the table
  const std::vector<scenes::Camera> cameras = scenes::turntable(camera, kFrames);
  const raytrace::Tracer tracer = raytrace::make_tracer(scene, options.build);
  const bool prints = world == nullptr || world->rank() == 0;
  if (prints) {
    std::printf("%s, %s, %s, %d %s x %d threads\n", name.c_str(), integrator.c_str(),
                arguments.turntable ? "turntable" : "at rest",
                world == nullptr ? arguments.ranks : world->size(),
                world == nullptr ? "ranks" : "processes", arguments.threads);
  }

  std::vector<Variant> variants;
  for (const Variant& variant : kVariants) {
    bool wanted = arguments.only.empty() || variant.distribution == "replicated";
    for (const std::string& each : arguments.only) wanted = wanted || each == variant.name;
    if (wanted) variants.push_back(variant);
  }
  std::vector<Times> times(variants.size());
  std::vector<raytrace::Statistics> last(variants.size());
  const auto run_rank = [&](comm::Communicator& communicator) {
    std::vector<Side> sides(variants.size());
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const raytrace::Distribution& distribution =
          *raytrace::find_distribution(variants[i].distribution);
      if (distribution.replicated) {
        sides[i].renderer.emplace(tracer);
        continue;
      }
      raytrace::ShareOptions share;
      share.build = options.build;
      if (arguments.random) share.assignment = raytrace::ShareOptions::Assignment::random;
      share.cache_bytes =
          static_cast<std::uint64_t>(variants[i].cache * static_cast<double>(tracer.bytes));
      sides[i].scene.emplace(raytrace::SharedScene::make(communicator, scene, share));
      sides[i].renderer.emplace(*sides[i].scene, distribution);
    }
    for (int turn = 0; turn < arguments.warm + arguments.turns; ++turn) {
      double replicated = 0.0, replicated_processor = 0.0;
      std::vector<image::RgbaF> first;
      for (std::size_t i = 0; i < variants.size(); ++i) {
        const scenes::Camera& from = arguments.turntable ? cameras[turn % kFrames] : camera;
        comm::barrier(communicator);
        const double start = processor_seconds();
        raytrace::Result result = sides[i].renderer->render(communicator, from, options);
        comm::barrier(communicator);
        const double processor = processor_seconds() - start;
        if (communicator.rank() != 0) continue;
        if (i == 0) {
          replicated_processor = processor;
          replicated = result.statistics.frame_seconds;
          first.assign(&result.image.colour[0], &result.image.colour[0] + result.image.pixels());
        }
        std::size_t unlike = 0;
        for (std::size_t k = 0; k < first.size(); ++k) {
          unlike += std::memcmp(&first[k], &result.image.colour[k], sizeof first[k]) != 0 ? 1 : 0;
        }
        if (unlike != 0) {
          std::printf("  %s, frame %d: %zu pixels differ\n", variants[i].name.c_str(), turn,
                      unlike);
        }
        if (turn >= arguments.warm) {
          times[i].seconds.push_back(result.statistics.frame_seconds);
          times[i].ratios.push_back(result.statistics.frame_seconds / replicated);
          times[i].processor.push_back(processor / replicated_processor);
        }
        last[i] = std::move(result.statistics);
        sides[i].renderer->recycle(std::move(result.image));
      }
    }
  };
  if (world == nullptr) {
    comm::run_threads(arguments.ranks, arguments.threads, run_rank);
  } else {
    parallel::Arena(arguments.threads).execute([&] { run_rank(*world); });
  }
  if (!prints) return;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    print(variants[i], times[i], last[i]);
    if (i == 0) continue;
    const Variant& variant = variants[i];
    const double bar = arguments.turntable    ? variant.turning
                       : integrator == "path" ? variant.path
                                              : variant.at_rest;
    bench::report_ratio(name + ", " + integrator +
                            (arguments.turntable ? ", turntable, " : ", at rest, ") + variant.name,
                        bench::median(times[i].ratios), bench::Better::lower, bar);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Arguments arguments;
  CLI::App app("Distributions of a scene over ranks beside a scene that every rank has");
  app.add_option("--width", arguments.width);
  app.add_option("--height", arguments.height);
  app.add_option("--ranks", arguments.ranks);
  app.add_option("--threads", arguments.threads);
  app.add_option("--turns", arguments.turns);
  app.add_option("--warm", arguments.warm, "frames before the first that counts");
  app.add_option("--integrator", arguments.integrators)->delimiter(',');
  app.add_option("--only", arguments.only, "variants beside replicated")->delimiter(';');
  app.add_flag("--turntable", arguments.turntable, "5 degrees from frame to frame");
  app.add_flag("--random", arguments.random, "assign clusters to ranks at random");
  app.add_option("SCENE", arguments.scenes);
  CLI11_PARSE(app, argc, argv);
  const auto compare_all = [&](comm::Communicator* world) {
    for (const std::string& scene : arguments.scenes) {
      for (const std::string& integrator : arguments.integrators)
        compare(scene, integrator, arguments, world);
    }
  };
  if (comm::launched_by_mpi()) {
    comm::run_mpi(&argc, &argv, [&](comm::Communicator& world) { compare_all(&world); });
  } else {
    compare_all(nullptr);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
