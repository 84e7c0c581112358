// Memory that rendering takes beyond the scene and the picture, for each triangle that is drawn.
#include <cstdio>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "scenes/generate.h"

using namespace delray;

constexpr double kMostBytes = 24;  // for each triangle that is drawn

// [SCENE ...]
int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = {"gen:terrain:1000000", "gen:terrain:10000000", "gen:field"};
  for (const std::string& name : names) {
    for (const int threads : {1, 2}) {
      const scenes::Scene scene = scenes::generate(name);
      const auto shader = std::make_shared<const shading::Shader>(shading::make_shader(scene));
      const std::size_t before = bench::peak_memory(true);
      raster::RenderOptions options;
      options.width = 1920;
      options.height = 1080;
      options.lighting = raster::Lighting::gouraud;
      raster::Statistics statistics;
      comm::run_threads(1, threads, [&](comm::Communicator& communicator) {
        raster::Renderer renderer(scene, shader);
        for (int frame = 0; frame < 2; ++frame) {
          raster::Result result = renderer.render(communicator, scene.cameras[0], options);
          renderer.recycle(std::move(result.picture));
          statistics = std::move(result.statistics);
        }
      });
      const std::size_t picture = std::size_t{1920} * 1080 * 8;
      const std::size_t used = bench::peak_memory(false) - before - picture;
      const double each =
          static_cast<double>(used) / static_cast<double>(statistics.triangles_rasterized);
      std::printf("%-22s %d threads: %6.1f MB, %llu triangles rasterized, %.1f bytes each\n",
                  name.c_str(), threads, static_cast<double>(used) * 1e-6,
                  static_cast<unsigned long long>(statistics.triangles_rasterized), each);
      bench::report_ratio(name + ", bytes a triangle, " + bench::thread_count(threads), each,
                          bench::Better::lower, kMostBytes);
    }
  }
}
