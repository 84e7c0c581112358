// What ranks gain: one picture by every strategy on two ranks with one thread each, beside one rank
// with two threads, and on four ranks beside two. 1920 x 1080, at rest and on a turntable; all take
// turns in one run; medians of a frame's time from a barrier until rank 0 has the picture, whose
// memory the next frame gets. Last, the bars that the ratios are held to.
//
// Under mpirun the ranks are its processes: their times alone, to be held beside those of threads.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raster/render.h"
#include "raster/strategies.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

using namespace delray;

namespace {

constexpr std::size_t kAround = 60;  // frames of a turntable

struct Request {
  std::vector<std::string> scenes;
  std::string strategy;  // empty: all
  int turns = 5, frames = 4;
  raster::Lighting lighting = raster::Lighting::phong;
  raster::Travel travel = raster::Travel::geometry;
  bool phases = false;
};

struct View {
  scenes::Scene scene;
  std::shared_ptr<const shading::Shader> shader;
  std::vector<scenes::Camera> cameras;
};

View load(const std::string& name) {
  std::vector<std::string> warnings;
  View view;
  view.scene = scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  const scenes::Camera camera = view.scene.cameras.empty()
                                    ? scenes::camera_around(view.scene, "default", 16.0F / 9)
                                    : view.scene.cameras[0];
  scenes::complete(view.scene, camera);
  view.shader = std::make_shared<const shading::Shader>(shading::make_shader(view.scene));
  view.cameras = scenes::turntable(camera, static_cast<int>(kAround));
  return view;
}

// Milliseconds of frames.
struct Times {
  std::vector<double> at_rest, turning;
  raster::Phases phases_at_rest, phases_turning;  // summed
};

// A strategy on so many ranks. Renderers live as long as it does.
class Configuration {
 public:
  Configuration(const View& view, std::string strategy, int ranks, int threads,
                const Request& request)
      : view_(view), strategy_(std::move(strategy)), ranks_(ranks), threads_(threads) {
    options_.width = 1920;
    options_.height = 1080;
    options_.strategy = strategy_;
    options_.lighting = request.lighting;
    options_.travel = request.travel;
    ranks_memory_.resize(static_cast<std::size_t>(ranks));
  }

  void run(int frames) {
    comm::run_threads(ranks_, threads_,
                      [&](comm::Communicator& communicator) { run_rank(communicator, frames); });
  }
  // One rank's part. Frames at rest come after one that is not timed, and so do those that turn:
  // the first is a step from the camera before it as well, and no jump from the one at rest.
  void run_rank(comm::Communicator& communicator, int frames) {
    auto& [renderer, turned] = ranks_memory_[static_cast<std::size_t>(communicator.rank())];
    if (!renderer) renderer.emplace(view_.scene, view_.shader);
    const auto render = [&](const scenes::Camera& camera, std::vector<double>* times,
                            raster::Phases* phases) {
      comm::barrier(communicator);
      const double begin = communicator.seconds();
      raster::Result result = renderer->render(communicator, camera, options_);
      if (communicator.rank() != 0) return;
      if (times != nullptr) {
        times->push_back((communicator.seconds() - begin) * 1e3);
        *phases += result.statistics.phases;
      }
      renderer->recycle(std::move(result.picture));
    };
    render(view_.cameras[0], nullptr, nullptr);
    for (int i = 0; i < frames; ++i) {
      render(view_.cameras[0], &times_.at_rest, &times_.phases_at_rest);
    }
    if (turned != 0) render(view_.cameras[turned], nullptr, nullptr);
    for (int i = 0; i < frames; ++i) {
      turned = (turned + 1) % kAround;
      render(view_.cameras[turned], &times_.turning, &times_.phases_turning);
    }
  }

  const std::string& strategy() const { return strategy_; }
  int ranks() const { return ranks_; }
  int threads() const { return threads_; }
  double at_rest() const { return bench::median(times_.at_rest); }
  double turning() const { return bench::median(times_.turning); }
  void print_phases() const {
    std::printf("  %-12s %d x %d", strategy_.c_str(), ranks_, threads_);
    for (const auto& [phases, frames] : {std::pair{times_.phases_at_rest, times_.at_rest.size()},
                                         std::pair{times_.phases_turning, times_.turning.size()}}) {
      std::printf("   ");
      for (const double seconds : {phases.transform, phases.bin, phases.rasterize, phases.shade,
                                   phases.redistribute, phases.compose, phases.gather})
        std::printf(" %6.1f", seconds * 1e3 / static_cast<double>(frames));
    }
    std::printf("\n");
  }

 private:
  const View& view_;
  const std::string strategy_;
  const int ranks_, threads_;
  raster::RenderOptions options_;
  struct Memory {
    std::optional<raster::Renderer> renderer;
    std::size_t turned = 0;  // the last camera
  };
  std::vector<Memory> ranks_memory_;
  Times times_;  // rank 0's
};

// Of two ranks over two threads, at rest and turning, by terrain, city, model.
struct Bars {
  const char* strategy;
  double at_rest[3], turning[3];
};
constexpr Bars kBars[] = {{"sort-last", {1.15, 1.25, 1.35}, {1.15, 1.25, 1.35}},
                          {"sort-first", {1.15, 1.2, 1.35}, {1.25, 1.35, 1.5}},
                          {"sort-middle", {1.5, 1.5, 1.4}, {1.5, 1.5, 1.4}},
                          {"hybrid", {1.2, 1.25, 1.35}, {1.35, 1.4, 1.5}}};
constexpr double kFourOverTwoAtRest = 1.2, kFourOverTwoTurning = 1.3;

void print_ratio(double ratio, double bar) {
  std::printf("  %6.2f %s %4.2f", ratio, ratio <= bar ? "<=" : "> ", bar);
}

void compare(const std::string& name, std::size_t kind, const Request& request) {
  const View view = load(name);
  std::vector<std::unique_ptr<Configuration>> configurations;
  const auto add = [&](const char* strategy, int ranks, int threads) -> Configuration& {
    return *configurations.emplace_back(
        std::make_unique<Configuration>(view, strategy, ranks, threads, request));
  };
  const Configuration& alone = add("sort-last", 1, 2);
  struct Row {
    const Bars& bars;
    const Configuration &two, &four;
  };
  std::vector<Row> rows;
  for (const Bars& bars : kBars) {
    if (request.strategy.empty() || request.strategy == bars.strategy)
      rows.push_back({bars, add(bars.strategy, 2, 1), add(bars.strategy, 4, 1)});
  }
  for (int turn = 0; turn < request.turns; ++turn)
    for (const auto& configuration : configurations) configuration->run(request.frames);

  std::printf("%s: 1 rank x 2 threads %.1f ms at rest, %.1f turning\n", name.c_str(),
              alone.at_rest(), alone.turning());
  for (const Row& row : rows) {
    std::printf("  %-12s %6.1f %6.1f ms, %6.1f %6.1f ms", row.bars.strategy, row.two.at_rest(),
                row.four.at_rest(), row.two.turning(), row.four.turning());
    const auto ratio = [&](const char* what, double over, double under, double bar) {
      print_ratio(over / under, bar);
      bench::report_ratio(name + ", " + row.bars.strategy + ", " + what, over / under,
                          bench::Better::lower, bar);
    };
    ratio("2 ranks over 2 threads", row.two.at_rest(), alone.at_rest(), row.bars.at_rest[kind]);
    ratio("the same turning", row.two.turning(), alone.turning(), row.bars.turning[kind]);
    ratio("4 ranks over 2", row.four.at_rest(), row.two.at_rest(), kFourOverTwoAtRest);
    ratio("4 over 2 turning", row.four.turning(), row.two.turning(), kFourOverTwoTurning);
    std::printf("\n");
  }
  if (request.phases) {
    std::printf(
        "  summed over ranks, at rest and turning: transform, bin, rasterize, shade, redistribute, "
        "compose, gather\n");
    for (const auto& configuration : configurations) configuration->print_phases();
  }
  std::fflush(stdout);
}

void measure_mpi(comm::Communicator& world, const Request& request) {
  parallel::Arena arena(1);
  for (const std::string& name : request.scenes) {
    const View view = load(name);
    for (const Bars& bars : kBars) {
      if (!request.strategy.empty() && request.strategy != bars.strategy) continue;
      Configuration configuration(view, bars.strategy, world.size(), 1, request);
      for (int turn = 0; turn < request.turns; ++turn)
        arena.execute([&] { configuration.run_rank(world, request.frames); });
      if (world.rank() != 0) continue;
      std::printf("%-20s %-12s %d processes %6.1f ms, %6.1f ms\n", name.c_str(), bars.strategy,
                  world.size(), configuration.at_rest(), configuration.turning());
      std::fflush(stdout);
    }
  }
}

}  // namespace

// [--turns N] [--frames N] [--gouraud] [--numbers] [--phases] [--strategy NAME] [SCENE ...]: with
// --numbers primitives travel as their numbers; scenes as delray render takes them. Bars are by
// kind: terrain, city, any other.
int main(int argc, char** argv) try {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* option) { return std::strcmp(argv[i], option) == 0; };
    const bool has_value = i + 1 < argc;
    if (is("--turns") && has_value) {
      request.turns = std::atoi(argv[++i]);
    } else if (is("--frames") && has_value) {
      request.frames = std::atoi(argv[++i]);
    } else if (is("--strategy") && has_value) {
      request.strategy = argv[++i];
    } else if (is("--phases")) {
      request.phases = true;
    } else if (is("--numbers")) {
      request.travel = raster::Travel::numbers;
    } else if (is("--gouraud")) {
      request.lighting = raster::Lighting::gouraud;
    } else if (argv[i][0] == '-') {
      throw std::invalid_argument(std::string(argv[i]) + ": not an option, or without a value");
    } else {
      request.scenes.emplace_back(argv[i]);
    }
  }
  if (request.scenes.empty())
    request.scenes = {"gen:terrain:5000000", "gen:city:1000000", "gen:spheres:124000"};
  if (comm::launched_by_mpi()) {
    comm::run_mpi(&argc, &argv, [&](comm::Communicator& world) { measure_mpi(world, request); });
    return 0;
  }
  std::printf(
      "ms a frame: 2 and 4 ranks at rest, 2 and 4 turning; then 2 ranks x 1 thread over 1 x "
      "2 at rest and turning, 4 ranks over 2 at rest and turning, each beside its bar\n");
  for (std::size_t i = 0; i < request.scenes.size(); ++i) {
    const std::string& name = request.scenes[i];
    const std::size_t kind = name.starts_with("gen:terrain") ? 0
                             : name.starts_with("gen:city")  ? 1
                                                             : 2;
    compare(name, kind, request);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
