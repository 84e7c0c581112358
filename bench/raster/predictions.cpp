// How far predicted frame times are from measured ones: every strategy on 1, 2 and 4 ranks of one
// thread each, 1920 x 1080, at rest and on a turntable. Ranks that are threads of this process are
// measured, and the simulated machine predicts the same frames, in turns in one run; medians.
//
// Last, 64 ranks that only count, at prices of 4 to 16, beside 64 that are timed: how far the model
// of more ranks than anybody times is from that of fewer, with the parts of the busiest rank's
// time.
//
// The model of this machine, measured first: a message costs what it takes round a ring of as many
// ranks, its bytes nothing; ranks at work at the same time slow each other down as so many
// renderers on their own do; more ranks than cores take turns on them (Network::shared_cores).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "bench/this_machine.h"
#include "comm/collectives.h"
#include "comm/threads.h"
#include "composite/codec.h"
#include "composite/layer_costs.h"
#include "parallel/arena.h"
#include "raster/predicted_frame.h"
#include "raster/strategies.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

using namespace delray;

namespace {

constexpr int kRanks[] = {1, 2, 4};
constexpr double kBar = 0.15;
constexpr std::size_t kAround = 60;  // frames of a turntable

struct View {
  scenes::Scene scene;
  std::shared_ptr<const shading::Shader> shader;
  std::vector<scenes::Camera> cameras;  // the first is not timed, half of the rest are at rest
  std::size_t at_rest = 0;              // so many follow the first
};

View load(const std::string& name, std::size_t frames) {
  std::vector<std::string> warnings;
  View view;
  view.scene = scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  const scenes::Camera camera = view.scene.cameras.empty()
                                    ? scenes::camera_around(view.scene, "default", 16.0F / 9)
                                    : view.scene.cameras[0];
  scenes::complete(view.scene, camera);
  view.shader = std::make_shared<const shading::Shader>(shading::make_shader(view.scene));
  // Shares of sort-last come to rest first.
  constexpr std::size_t kSettle = 3;
  view.cameras.assign(1 + kSettle + frames, camera);
  view.at_rest = kSettle + frames;
  const std::vector<scenes::Camera> around = scenes::turntable(camera, kAround);
  for (std::size_t i = 1; i <= frames; ++i) view.cameras.push_back(around[i]);
  return view;
}

// Seconds of frames.
struct Times {
  std::vector<double> at_rest, turning;
  void add(const View& view, std::size_t frame, double seconds) {
    const std::size_t timed = view.cameras.size() - 1 - view.at_rest;  // of either kind
    if (frame > view.at_rest)
      turning.push_back(seconds);
    else if (frame + timed > view.at_rest)
      at_rest.push_back(seconds);
  }
};

raster::RenderOptions options_of(const char* strategy) {
  raster::RenderOptions options;
  options.width = 1920;
  options.height = 1080;
  options.strategy = strategy;
  options.codec = "active";
  options.redistribution = raster::Redistribution::at_end;
  return options;
}

void measure(const View& view, const raster::RenderOptions& options, int ranks, Times& times) {
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    raster::Renderer renderer(view.scene, view.shader);
    for (std::size_t i = 0; i < view.cameras.size(); ++i) {
      comm::barrier(communicator);
      const double begin = communicator.seconds();
      raster::Result frame = renderer.render(communicator, view.cameras[i], options);
      if (communicator.rank() == 0) times.add(view, i, communicator.seconds() - begin);
      renderer.recycle(std::move(frame.picture));
    }
  });
}

void predict(const View& view, const raster::RenderOptions& options, int ranks,
             const comm::Network& machine, Times& times) {
  const raster::SimulatedFrames simulated =
      raster::simulate_frames({view.scene, view.shader, view.cameras}, options, ranks, nullptr);
  for (std::size_t i = 0; i < simulated.frames.size(); ++i)
    times.add(view, i, raster::predict(simulated.frames[i], machine).seconds);
}

double contention(const View& view, int ranks) {
  return bench::contention(ranks, [&](comm::Communicator& communicator) {
    // Moves with the closure: what it refers to stays where it is.
    return [own = communicator.split(communicator.rank(), 0),
            renderer = std::make_unique<raster::Renderer>(view.scene, view.shader),
            options = options_of("sort-last"), &view] {
      raster::Result frame = renderer->render(*own, view.cameras[0], options);
      renderer->recycle(std::move(frame.picture));
    };
  });
}

struct Row {
  const char* strategy;
  int ranks;
  Times measured, predicted;
};

// Prints and returns the error.
double tell(const std::string& name, const Row& row, const char* kind,
            std::vector<double> Times::*times) {
  const double measured = bench::median(row.measured.*times);
  const double predicted = bench::median(row.predicted.*times);
  const double error = predicted / measured - 1;
  std::printf("  %7.1f %7.1f %+5.1f %%%s", measured * 1e3, predicted * 1e3, error * 1e2,
              std::abs(error) <= kBar ? " " : "!");
  bench::report_ratio(
      name + ", " + row.strategy + " on " + std::to_string(row.ranks) + ", " + kind + ": error",
      1 + std::abs(error), bench::Better::lower, 1 + kBar);
  return std::abs(error);
}

// Where the busiest rank's time goes in turning frames.
struct Parts {
  std::vector<std::array<double, raster::kParts>> timed, counted;
};

void tell(const Parts& parts) {
  std::printf("    turning:");
  for (std::size_t p = 0; p < raster::kParts; ++p) {
    const auto of = [&](const std::vector<std::array<double, raster::kParts>>& frames) {
      std::vector<double> seconds;
      for (const auto& frame : frames) seconds.push_back(frame[p]);
      return bench::median(seconds) * 1e3;
    };
    std::printf(" %s %.2f %.2f;", raster::name(static_cast<raster::Part>(p)), of(parts.timed),
                of(parts.counted));
  }
  std::printf("\n");
}

// Ranks that only count, at prices of fewer, beside as many that are timed; over InfiniBand, where
// messages hide least.
void extrapolate(const std::string& name, const View& view) {
  constexpr int kFew[] = {4, 8, 16};
  constexpr int kMany = 64;
  const comm::Network& network = comm::find_network("hdr-infiniband")->network;
  const auto primitives = scenes::first_primitives(view.scene).back();
  const auto simulated = [&](const raster::RenderOptions& options, int ranks) {
    return raster::simulate_frames({view.scene, view.shader, view.cameras}, options, ranks, nullptr)
        .frames;
  };
  const composite::LayerCosts costs =
      composite::measure_layer_costs(*composite::find_codec("active"));
  std::vector<Row> rows;
  std::vector<Parts> parts;  // of the rows
  for (const raster::Strategy& strategy : raster::strategies()) {
    raster::RenderOptions options = options_of(strategy.name);
    Row& row = rows.emplace_back(Row{strategy.name, kMany, {}, {}});
    Parts& split = parts.emplace_back();
    std::vector<raster::SimulatedFrame> at_rest, turning;
    for (const int ranks : kFew) {
      std::vector<raster::SimulatedFrame> frames = simulated(options, ranks);
      for (std::size_t i = 1; i < frames.size(); ++i)
        (i > view.at_rest ? turning : at_rest).push_back(std::move(frames[i]));
    }
    const raster::DrawingPrices still = raster::fit_prices(at_rest, primitives);
    const raster::DrawingPrices moving = raster::fit_prices(turning, primitives);
    const std::vector<raster::SimulatedFrame> timed = simulated(options, kMany);
    options.count_only = costs;
    std::vector<raster::SimulatedFrame> counted = simulated(options, kMany);
    for (std::size_t i = 1; i < timed.size(); ++i) {
      raster::apply_prices(i > view.at_rest ? moving : still, primitives, counted[i]);
      const raster::PredictedFrame of_timed = raster::predict(timed[i], network);
      const raster::PredictedFrame of_counted = raster::predict(counted[i], network);
      row.measured.add(view, i, of_timed.seconds);
      row.predicted.add(view, i, of_counted.seconds);
      if (i <= view.at_rest) continue;
      split.timed.push_back(of_timed.parts);
      split.counted.push_back(of_counted.parts);
    }
  }
  std::printf("  %d ranks over InfiniBand, timed and counted:\n", kMany);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::printf("  %d ranks %-12s", rows[k].ranks, rows[k].strategy);
    tell(name, rows[k], "at rest", &Times::at_rest);
    tell(name, rows[k], "turning", &Times::turning);
    std::printf("\n");
    tell(parts[k]);
  }
}

void compare(const std::string& name, int turns, std::size_t frames) {
  const View view = load(name, frames);
  std::printf("%s\n", name.c_str());
  if (turns == 0) return extrapolate(name, view);
  std::map<int, comm::Network> machines;  // by ranks
  for (const int ranks : kRanks) {
    const double slower = ranks > 1 ? contention(view, ranks) : 1;
    const comm::Network& machine = machines[ranks] = bench::this_machine(ranks, slower);
    if (ranks == 1) continue;
    std::printf("  %d ranks: a message takes %.1f us; work takes %.3f times as long\n", ranks,
                (machine.latency + 2 * machine.overhead) * 1e6, slower);
  }
  std::vector<Row> rows;
  for (const int ranks : kRanks) {
    for (const raster::Strategy& strategy : raster::strategies())
      if (ranks > 1 || rows.empty()) rows.push_back({strategy.name, ranks, {}, {}});
  }
  for (int turn = 0; turn < turns; ++turn) {
    for (Row& row : rows) {
      const raster::RenderOptions options = options_of(row.strategy);
      measure(view, options, row.ranks, row.measured);
      predict(view, options, row.ranks, machines.at(row.ranks), row.predicted);
    }
  }
  std::vector<double> errors;
  for (const Row& row : rows) {
    std::printf("  %d ranks %-12s", row.ranks, row.strategy);
    errors.push_back(tell(name, row, "at rest", &Times::at_rest));
    errors.push_back(tell(name, row, "turning", &Times::turning));
    std::printf("\n");
  }
  const auto within =
      std::count_if(errors.begin(), errors.end(), [](double error) { return error <= kBar; });
  std::printf("  %d of %d within %.0f %%; median %.1f %%, largest %.1f %%\n",
              static_cast<int>(within), static_cast<int>(errors.size()), kBar * 1e2,
              bench::median(errors) * 1e2, *std::max_element(errors.begin(), errors.end()) * 1e2);
  extrapolate(name, view);
  std::fflush(stdout);
}

}  // namespace

// [--turns N] [--frames N] [SCENE ...], scenes as delray render takes them. No turns: only the
// last.
int main(int argc, char** argv) {
  std::vector<std::string> names;
  int turns = 3, frames = 5;
  for (int i = 1; i < argc; ++i) {
    const bool has_value = i + 1 < argc;
    if (std::strcmp(argv[i], "--turns") == 0 && has_value)
      turns = std::atoi(argv[++i]);
    else if (std::strcmp(argv[i], "--frames") == 0 && has_value)
      frames = std::atoi(argv[++i]);
    else
      names.emplace_back(argv[i]);
  }
  if (names.empty()) names = {"gen:terrain:5000000", "gen:city:1000000", "gen:spheres:124000"};
  std::printf(
      "ms a frame at rest: measured, predicted, error; the same turning; ! beyond %.0f %%\n",
      kBar * 1e2);
  for (const std::string& name : names) compare(name, turns, static_cast<std::size_t>(frames));
}
