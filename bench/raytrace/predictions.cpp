// How far predicted frame times of the ray tracer are from measured ones: schedules over a scene
// that every rank has, and distributions of a scene, on 1, 2 and 4 ranks of one thread each, 1280 x
// 720, one sample. Ranks that are threads of this process are measured, and the simulated machine
// (bench/this_machine.h) predicts the same frames, in turns in one run; medians.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "bench/this_machine.h"
#include "comm/collectives.h"
#include "comm/threads.h"
#include "raytrace/simulated_frames.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

using namespace delray;

namespace {

constexpr int kRanks[] = {1, 2, 4};
constexpr double kBar = 0.15;
constexpr const char* kSchedules[] = {"interlaced", "demand", "stealing"};

struct View {
  scenes::Scene scene;
  std::optional<raytrace::Tracer> tracer;
  scenes::Camera camera;
};

View load(const std::string& name) {
  std::vector<std::string> warnings;
  View view;
  view.scene = scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  view.camera = view.scene.cameras.empty() ? scenes::camera_around(view.scene, "default", 16.0F / 9)
                                           : view.scene.cameras[0];
  scenes::complete(view.scene, view.camera);
  view.tracer.emplace(raytrace::make_tracer(view.scene));
  return view;
}

raytrace::RenderOptions options_of(const std::string& integrator, const char* schedule) {
  raytrace::RenderOptions options;
  options.integrator = integrator;
  options.schedule = schedule;
  return options;
}

// Frames that are not timed: parts of the scene and tiles come to the ranks where they stay.
constexpr int kNotTimed = 4;

void measure(const View& view, const raytrace::RenderOptions& options,
             const raytrace::Distribution& distribution, int ranks, int frames,
             std::vector<double>& times) {
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    std::optional<raytrace::SharedScene> shared;
    if (!distribution.replicated)
      shared.emplace(raytrace::SharedScene::make(communicator, view.scene, view.tracer->shader,
                                                 raytrace::share_options(distribution, {})));
    raytrace::Renderer renderer =
        shared ? raytrace::Renderer(*shared, distribution) : raytrace::Renderer(*view.tracer);
    for (int i = 0; i < kNotTimed + frames; ++i) {
      comm::barrier(communicator);
      const double begin = communicator.seconds();
      raytrace::Result frame = renderer.render(communicator, view.camera, options);
      if (communicator.rank() != 0) continue;
      if (i >= kNotTimed) times.push_back(communicator.seconds() - begin);
      renderer.recycle(std::move(frame.image));
    }
  });
}

struct Row {
  std::string name;
  const char* schedule;
  const raytrace::Distribution* distribution;
  int ranks;
  std::vector<double> measured, predicted;
};

void compare(const std::string& name, const std::string& integrator, int turns, int frames) {
  const View view = load(name);
  std::printf("%s, %s\n", name.c_str(), integrator.c_str());
  const raytrace::Distribution& replicated = *raytrace::find_distribution("replicated");
  std::map<int, comm::Network> machines;  // by ranks
  std::vector<Row> rows;
  for (const int ranks : kRanks) {
    double slower = 1;
    if (ranks > 1) {
      slower = bench::contention(ranks, [&](comm::Communicator& communicator) {
        return [own = communicator.split(communicator.rank(), 0),
                renderer = std::make_unique<raytrace::Renderer>(*view.tracer),
                options = options_of(integrator, "interlaced"), &view] {
          raytrace::Result frame = renderer->render(*own, view.camera, options);
          renderer->recycle(std::move(frame.image));
        };
      });
      std::printf("  %d ranks: work takes %.3f times as long\n", ranks, slower);
    }
    machines[ranks] = bench::this_machine(ranks, slower);
    for (const char* schedule : kSchedules)
      rows.push_back({schedule, schedule, &replicated, ranks, {}, {}});
    if (ranks == 1) continue;
    for (const raytrace::Distribution& distribution : raytrace::distributions())
      if (!distribution.replicated)
        rows.push_back({distribution.name, "interlaced", &distribution, ranks, {}, {}});
  }
  for (int turn = 0; turn < turns; ++turn) {
    for (Row& row : rows) {
      const raytrace::RenderOptions options = options_of(integrator, row.schedule);
      measure(view, options, *row.distribution, row.ranks, frames, row.measured);
      const std::vector<raytrace::SimulatedFrame> simulated = raytrace::simulate_frames(
          {view.scene, *view.tracer, view.camera, options, kNotTimed + frames}, *row.distribution,
          row.ranks, machines.at(row.ranks));
      for (std::size_t i = kNotTimed; i < simulated.size(); ++i)
        row.predicted.push_back(simulated[i].seconds);
    }
  }
  std::vector<double> errors;
  for (const Row& row : rows) {
    const double measured = bench::median(row.measured), predicted = bench::median(row.predicted);
    const double error = predicted / measured - 1;
    errors.push_back(std::abs(error));
    std::printf("  %d ranks %-12s %7.1f %7.1f %+5.1f %%%s\n", row.ranks, row.name.c_str(),
                measured * 1e3, predicted * 1e3, error * 1e2, errors.back() <= kBar ? "" : " !");
    bench::report_ratio(
        name + ", " + integrator + ", " + row.name + " on " + std::to_string(row.ranks) + ": error",
        1 + errors.back(), bench::Better::lower, 1 + kBar);
  }
  const auto within =
      std::count_if(errors.begin(), errors.end(), [](double error) { return error <= kBar; });
  std::printf("  %d of %d within %.0f %%; median %.1f %%, largest %.1f %%\n",
              static_cast<int>(within), static_cast<int>(errors.size()), kBar * 1e2,
              bench::median(errors) * 1e2, *std::max_element(errors.begin(), errors.end()) * 1e2);
  std::fflush(stdout);
}

}  // namespace

// [--turns N] [--frames N] [--integrator NAME] [SCENE ...], scenes as delray render takes them.
int main(int argc, char** argv) {
  std::vector<std::string> names;
  std::string integrator = "direct";
  int turns = 2, frames = 3;
  for (int i = 1; i < argc; ++i) {
    const bool has_value = i + 1 < argc;
    if (std::strcmp(argv[i], "--turns") == 0 && has_value)
      turns = std::atoi(argv[++i]);
    else if (std::strcmp(argv[i], "--frames") == 0 && has_value)
      frames = std::atoi(argv[++i]);
    else if (std::strcmp(argv[i], "--integrator") == 0 && has_value)
      integrator = argv[++i];
    else
      names.emplace_back(argv[i]);
  }
  if (names.empty()) names = {"gen:terrain:2000000", "gen:spheres:124000"};
  std::printf("ms a frame: measured, predicted, error; ! beyond %.0f %%\n", kBar * 1e2);
  for (const std::string& name : names) compare(name, integrator, turns, frames);
}
