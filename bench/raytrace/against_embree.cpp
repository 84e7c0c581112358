// Delray's integrators beside loops over the same rays that call Embree and do nothing else:
//
//   raytrace_against_embree [--width W] [--height H] [--turns N] [--threads N,N...] [--spp N]
//                           [--same-answers] [--isa ISA] [--alone] [CASE...]
//
// CASE is INTEGRATOR:SCENE, SCENE a file or gen:KIND[:TRIANGLES[:SEED]]; INTEGRATOR is one of the
// table's or "primary": direct light without shadows. The rays of one frame are recorded, in groups
// as they were asked for, and given to bare loops that read groups from memory: single rays,
// packets, coherent packets, streams of 256. For each kind of ray (primary; other nearest hits;
// shadows by camera rays; other shadows) the fastest loop counts. Both sides take turns; the table
// has rays per second of all kinds, Delray's frame (from the camera to the image) over the sum of
// the fastest loops', medians, and Delray's speed-up over the first number of threads. The bare
// structure has Embree's default flags and bare shadow rays end at the first hit; Delray's is
// robust and its shadow rays pass glass and blended surfaces, and with --same-answers so it is
// there. The last ratio is of processor time, which tells more on a busy machine. With --alone, for
// profiles, only Delray's frames are timed.
#include <time.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "bench/measure.h"
#include "bench/peers/embree.h"
#include "bench/ratio.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raytrace/integrator.h"
#include "raytrace/integrators/intersect.h"
#include "raytrace/render.h"
#include "raytrace/scene/flush_to_zero.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

namespace {

using namespace delray;

struct Arguments {
  int width = 1920, height = 1080, turns = 5, spp = 1;
  std::vector<int> threads = {1, 2};
  bool same_answers = false, alone = false;
  std::string isa;
  std::vector<std::string> cases = {"primary:gen:terrain:10000000", "whitted:gen:spheres",
                                    "path:gen:field"};
};

struct Kind {
  const char* name;
  bool shadows;
  std::vector<bench::RecordedGroup> groups;
  std::uint64_t rays = 0;
  bench::Loop fastest = bench::Loop::single;
};

// Kinds of rays: camera, other, shadows of camera rays, other shadows.
using Recorded = std::array<Kind, 4>;

void record(const raytrace::ActiveRays& active, const auto& packet, Kind& kind) {
  bench::RecordedGroup& group = kind.groups.emplace_back();
  const auto copy = [](const float* from, float* to) { std::copy_n(from, 16, to); };
  copy(packet.origin_x, group.origin_x);
  copy(packet.origin_y, group.origin_y);
  copy(packet.origin_z, group.origin_z);
  copy(packet.near, group.near);
  copy(packet.direction_x, group.direction_x);
  copy(packet.direction_y, group.direction_y);
  copy(packet.direction_z, group.direction_z);
  copy(packet.far, group.far);
  for (int i = 0; i < raytrace::kPacketRays; ++i) {
    if (active.ray[i] != 0) {
      ++kind.rays;
      continue;
    }
    group.near[i] = 1.0F;
    group.far[i] = 0.0F;
  }
}

Recorded record(const raytrace::Tracer& tracer, const scenes::Camera& camera,
                const raytrace::RenderOptions& options) {
  Recorded recorded = {Kind{"camera", false, {}}, Kind{"other", false, {}},
                       Kind{"shadows", true, {}}, Kind{"other shadows", true, {}}};
  const raytrace::FlushToZero flush;
  const shading::BatchShader shader = shading::make_batch_shader(tracer.shader);
  const scenes::View view = scenes::make_view(camera, options.width, options.height);
  const raytrace::FrameContext context{shader, tracer.lights, view, options.trace, options.samples};
  const std::unique_ptr<raytrace::WavefrontIntegrator> wavefront =
      raytrace::integrator(options.integrator).make(context);
  constexpr int kSide = 16;
  for (int y = 0; y < options.height; y += kSide) {
    for (int x = 0; x < options.width; x += kSide) {
      for (int s = 0; s < options.samples; ++s) {
        const raytrace::Task task{geometry::intersection({x, y, x + kSide, y + kSide},
                                                         {0, 0, options.width, options.height}),
                                  s, 1};
        for (wavefront->start(task); !wavefront->done(); wavefront->advance()) {
          for (const raytrace::RayGroup& group : wavefront->batch().rays) {
            record(group.active, group.packet, recorded[group.coherent ? 0 : 1]);
          }
          for (const raytrace::ShadowGroup& group : wavefront->batch().shadows) {
            record(group.active, group.packet, recorded[group.coherent ? 2 : 3]);
          }
          intersect(tracer, shader, wavefront->batch());
        }
      }
    }
  }
  return recorded;
}

double bare_seconds(const bench::BareEmbree& bare, const Recorded& recorded, int threads) {
  double sum = 0.0;
  for (const Kind& kind : recorded) {
    if (kind.rays != 0) sum += bare.seconds(kind.groups, kind.shadows, kind.fastest, threads);
  }
  return sum;
}

void choose_loops(const bench::BareEmbree& bare, Recorded& recorded) {
  for (Kind& kind : recorded) {
    if (kind.rays == 0) continue;
    double best = 1e30;
    std::printf("  %-14s %10llu rays, million/s:", kind.name,
                static_cast<unsigned long long>(kind.rays));
    for (const bench::Loop loop : bench::kLoops) {
      if (!bare.can(loop, kind.shadows)) continue;
      const double seconds = std::min(bare.seconds(kind.groups, kind.shadows, loop, 1),
                                      bare.seconds(kind.groups, kind.shadows, loop, 1));
      std::printf(" %s %.1f", bench::name_of(loop),
                  1e-6 * static_cast<double>(kind.rays) / seconds);
      if (seconds < best) {
        best = seconds;
        kind.fastest = loop;
      }
    }
    std::printf("\n");
  }
}

// Of all threads of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void compare(const std::string& name, const Arguments& arguments) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) throw std::invalid_argument(name + " is not INTEGRATOR:SCENE");
  const std::string integrator = name.substr(0, colon), file = name.substr(colon + 1);
  raytrace::RenderOptions options;
  options.width = arguments.width;
  options.height = arguments.height;
  options.samples = arguments.spp;
  options.build.isa = arguments.isa;
  options.integrator = integrator == "primary" ? "direct" : integrator;
  options.trace.shadows = integrator != "primary";
  if (integrator == "path") options.trace.depth = options.trace.diffuse_depth = 4;

  std::vector<std::string> warnings;
  scenes::Scene scene =
      scenes::is_generated(file) ? scenes::generate(file) : scenes::load(file, warnings);
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  const scenes::Camera camera = !scene.cameras.empty()
                                    ? scene.cameras.front()
                                    : scenes::camera_around(scene, "default", aspect);
  scenes::complete(scene, camera);
  const raytrace::Tracer tracer = raytrace::make_tracer(scene, options.build);
  std::printf("%s\n", name.c_str());

  std::unique_ptr<bench::BareEmbree> bare;
  Recorded recorded;
  if (!arguments.alone) {
    bare = std::make_unique<bench::BareEmbree>(tracer.instances, arguments.same_answers,
                                               arguments.isa.c_str());
    recorded = record(tracer, camera, options);
    choose_loops(*bare, recorded);
  }
  const bench::KeepMemory keep;
  double first = 0.0;
  for (const int threads : arguments.threads) {
    std::vector<double> ours, theirs, ratios, processor;
    std::uint64_t rays = 0;
    comm::run_threads(1, threads, [&](comm::Communicator& communicator) {
      raytrace::Renderer renderer(tracer);
      for (int turn = 0; turn <= arguments.turns; ++turn) {
        const double start = processor_seconds();
        raytrace::Result result = renderer.render(communicator, camera, options);
        const raytrace::Statistics& statistics = result.statistics;
        rays = statistics.rays.primary + statistics.rays.shadow + statistics.rays.secondary;
        const double middle = processor_seconds();
        const double other = bare ? bare_seconds(*bare, recorded, threads) : 0.0;
        if (turn == 0) continue;
        ours.push_back(statistics.frame_seconds);
        theirs.push_back(other);
        ratios.push_back(other / statistics.frame_seconds);
        renderer.recycle(std::move(result.image));
        processor.push_back((processor_seconds() - middle) / (middle - start));
      }
    });
    const double seconds = bench::median(ours);
    if (first == 0.0) first = seconds;
    const double millions = 1e-6 * static_cast<double>(rays);
    std::printf(
        "  %d threads: %.1f ms, %.2f million rays/s; bare %.2f; ratio %.3f (%.3f); speed-up %.2f\n",
        threads, 1e3 * seconds, millions / seconds, bare ? millions / bench::median(theirs) : 0.0,
        bench::median(ratios), bench::median(processor), first / seconds);
    if (!bare) continue;
    bench::report_ratio(integrator + " " + file.substr(file.rfind('/') + 1) + ", " +
                            bench::thread_count(threads) +
                            (arguments.same_answers ? ", same answers" : ""),
                        bench::median(ratios), bench::Better::higher);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  // Memory that threads of their own arenas free goes back to the system, warm or not.
  mallopt(M_ARENA_MAX, 1);
  Arguments arguments;
  CLI::App app("Delray's ray tracer beside bare Embree");
  app.add_option("--width", arguments.width);
  app.add_option("--height", arguments.height);
  app.add_option("--turns", arguments.turns);
  app.add_option("--spp", arguments.spp);
  app.add_option("--threads", arguments.threads)->delimiter(',');
  app.add_option("--isa", arguments.isa);
  app.add_flag("--same-answers", arguments.same_answers);
  app.add_flag("--alone", arguments.alone);
  app.add_option("case", arguments.cases);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& name : arguments.cases) compare(name, arguments);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
