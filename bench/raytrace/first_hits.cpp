// The time of primary visibility: first hits of camera rays by tracing all of them, and by
// rasterization with the rest traced (raytrace/first_hits/first_hits.h), which has to give the same
// bytes.
//
//   raytrace_first_hits [--width W] [--height H] [--turns N] [--spp N] [--isa ISA] [--alone]
//                       [SCENE...]
//
// SCENE is a file or gen:KIND[:TRIANGLES[:SEED]]. Processor time of one thread; both sides take
// turns, and the median of each counts. Both make the rays; points, materials and shading are left
// out, as they are the same. Columns: triangles, milliseconds of tracing, of `--primary raster`,
// which traces where that is expected to be as fast, and of rasterizing always, with the part of it
// that sorts triangles into squares; ratios to tracing, and the part of the rays that was
// rasterized.
#include <time.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "parallel/arena.h"
#include "raytrace/first_hits/first_hits.h"
#include "raytrace/integrator.h"
#include "raytrace/scene/flush_to_zero.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

namespace {

using namespace delray;

struct Arguments {
  int width = 1280, height = 720, turns = 9, samples = 1;
  bool alone = false;
  std::string isa;
  std::vector<std::string> scenes = {"gen:spheres", "gen:cornell", "gen:city", "gen:terrain",
                                     "gen:terrain:10000000"};
};

// Processor time of this thread, the only one, which other programs do not add to.
double seconds_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
  double all = 0.0, sorting = 0.0;  // seconds
  std::uint64_t rays = 0, rasterized = 0;
  std::uint64_t sum = 0;  // of the bits of all hits
};

enum class Way { trace, raster, raster_always };

class Visibility {
 public:
  Visibility(const raytrace::Tracer& tracer, const scenes::Camera& camera, const Arguments& a)
      : tracer_(tracer),
        shader_(shading::make_batch_shader(tracer.shader)),
        view_(scenes::make_view(camera, a.width, a.height)),
        samples_(a.samples),
        context_{shader_,
                 tracer.lights,
                 view_,
                 {},
                 a.samples,
                 false,
                 scenes::pixels_of(view_, tracer.embree.bounds())},
        integrator_(raytrace::integrator("direct").make(context_)) {}

  Times find(Way way, bool timed) {
    const raytrace::FlushToZero flush;
    Times times;
    const double start = seconds_now();
    const geometry::Rect frame{0, 0, view_.width, view_.height};
    raytrace::FirstHits::Made made;
    raytrace::FirstHits::Trials trials;  // none before: the first frame of a renderer
    if (way != Way::trace) {
      raytrace::SeenWindow window{view_, frame};
      window.longest = 1.001F * glm::length(view_.ray(0, 0));
      window.centred = samples_ == 1;
      made =
          raytrace::FirstHits::make(tracer_, window, samples_, way == Way::raster_always, trials);
      times.sorting = seconds_now() - start;
    }
    raytrace::FirstHits::Memory memory;
    for (int y = 0; y < frame.y1; y += raytrace::kTaskSide) {
      for (int x = 0; x < frame.x1; x += raytrace::kTaskSide) {
        for (int s = 0; s < samples_; ++s) {
          const raytrace::Task task{
              geometry::intersection({x, y, x + raytrace::kTaskSide, y + raytrace::kTaskSide},
                                     frame),
              s, 1};
          integrator_->start(task);
          raytrace::Groups<raytrace::RayGroup>& groups = integrator_->batch().rays;
          if (made.hits) times.rasterized += made.hits->find(task.pixels, groups, memory);
          for (std::size_t g = 0; g < groups.size(); ++g) {
            if (groups[g].misses) continue;
            const raytrace::ActiveRays& active = made.hits ? memory.left[g] : groups[g].active;
            if (raytrace::active_lanes(active) != 0)
              tracer_.embree.intersect(active, groups[g].packet, true);
          }
          if (!timed) {
            for (const raytrace::RayGroup& group : groups) add(group, times);
          }
        }
      }
    }
    times.all = seconds_now() - start;
    return times;
  }

 private:
  static void add(const raytrace::RayGroup& group, Times& times) {
    if (group.misses) return;
    for (int i = 0; i < raytrace::kPacketRays; ++i) {
      if (group.active.ray[i] == 0) continue;
      ++times.rays;
      std::uint32_t bits[5] = {0, 0, group.packet.triangle[i]};
      if (bits[2] != raytrace::kMiss) {
        const raytrace::Hit hit = raytrace::hit_of(group.packet, i);
        bits[0] = hit.instance;
        std::memcpy(bits + 1, &hit.distance, sizeof(float));
        std::memcpy(bits + 3, &hit.u, sizeof(float));
        std::memcpy(bits + 4, &hit.v, sizeof(float));
      }
      for (const std::uint32_t b : bits) times.sum = (times.sum ^ b) * 0x9E3779B97F4A7C15U;
    }
  }

  const raytrace::Tracer& tracer_;
  shading::BatchShader shader_;
  scenes::View view_;
  int samples_;
  raytrace::FrameContext context_;
  std::unique_ptr<raytrace::WavefrontIntegrator> integrator_;
};

scenes::Scene scene_of(const std::string& name) {
  std::vector<std::string> warnings;
  scenes::Scene scene =
      scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  scenes::complete(scene, scenes::Camera{});
  return scene;
}

void run(const Arguments& a) {
  std::printf("%-28s %9s %8s %8s %6s %8s %8s %6s %6s\n", "scene", "triangles", "trace ms", "raster",
              "ratio", "always", "sorting", "ratio", "part");
  for (const std::string& name : a.scenes) {
    const scenes::Scene scene = scene_of(name);
    raytrace::BuildOptions build;
    build.isa = a.isa;
    const raytrace::Tracer tracer = raytrace::make_tracer(scene, build);
    const scenes::Camera camera =
        scene.cameras.empty()
            ? scenes::camera_around(scene, "default",
                                    static_cast<float>(a.width) / static_cast<float>(a.height))
            : scene.cameras[0];
    Visibility visibility(tracer, camera, a);
    std::vector<double> seconds[3], sorting;
    Times last[3];
    for (int way = 0; way < 3; ++way) {
      last[way] = visibility.find(static_cast<Way>(way), false);
      if (last[way].sum != last[0].sum) throw std::runtime_error(name + ": other hits");
    }
    for (int turn = 0; turn < a.turns; ++turn) {
      for (int way = a.alone ? 2 : 0; way < 3; ++way) {
        const Times times = visibility.find(static_cast<Way>(way), true);
        seconds[way].push_back(times.all);
        if (way == 2) sorting.push_back(times.sorting);
      }
    }
    if (a.alone) continue;
    const double trace = bench::median(seconds[0]), raster = bench::median(seconds[1]);
    const double always = bench::median(seconds[2]);
    const std::string shown = name.size() > 28 ? name.substr(name.size() - 28) : name;
    std::printf("%-28s %9llu %8.2f %8.2f %6.2f %8.2f %8.2f %6.2f %6.4f\n", shown.c_str(),
                static_cast<unsigned long long>(scenes::triangle_count(scene)), 1e3 * trace,
                1e3 * raster, raster / trace, 1e3 * always, 1e3 * bench::median(sorting),
                always / trace,
                static_cast<double>(last[2].rasterized) / static_cast<double>(last[2].rays));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Primary visibility by rays and by rasterization");
  Arguments a;
  app.add_option("--width", a.width, "Pixels");
  app.add_option("--height", a.height, "Pixels");
  app.add_option("--turns", a.turns, "Frames of each");
  app.add_option("--spp", a.samples, "Samples per pixel");
  app.add_flag("--alone", a.alone, "Only rasterize, for profiles");
  app.add_option("--isa", a.isa, "Embree's instruction set");
  app.add_option("scenes", a.scenes, "Files or gen:KIND[:TRIANGLES[:SEED]]");
  CLI11_PARSE(app, argc, argv);
  try {
    parallel::Arena arena(1);
    arena.execute([&] { run(a); });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
