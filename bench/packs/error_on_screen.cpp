// How far what a pack shows with a bound of error is from its exact picture, and what that costs:
// frames of a turntable, each exact and with the bound, in turns.
//
// A pixel is displaced by r pixels if r is the least for which its depth is, within r pixels on the
// screen, between depths of the other picture that are r pixels around, either way.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>
#include <span>

#include "bench/measure.h"
#include "comm/threads.h"
#include "packs/extent.h"
#include "packs/pack_reader.h"
#include "raster/render.h"
#include "scenes/camera_path.h"
#include "scenes/framing.h"

using namespace delray;

namespace {

constexpr int kFarthest = 6;

int displaced_by(const image::Image8& a, const image::Image8& b, const scenes::View& view, int x,
                 int y) {
  const auto at = [&](const image::Image8& picture, int i, int j) {
    return picture.depth[static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(i)];
  };
  const float depth = at(a, x, y);
  float low = image::kEmptyDepth, high = 0;
  for (int r = 0; r <= kFarthest; ++r) {
    for (int j = y - r; j <= y + r; ++j) {
      for (int i = x - r; i <= x + r; ++i) {
        low = std::min(low, at(b, i, j));
        high = std::max(high, at(b, i, j));
      }
    }
    const float reach = static_cast<float>(r) * depth / view.scale;
    const bool found = depth == image::kEmptyDepth ? high == image::kEmptyDepth
                                                   : low - reach <= depth && depth <= high + reach;
    if (found) return r;
  }
  return kFarthest + 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Frames of a pack with a bound of error beside exact ones");
  std::string path;
  double error = 1;
  int views = 4, width = 1920, height = 1080, threads = 2;
  std::size_t cache = 1024;
  program.add_option("PACK", path)->required();
  program.add_option("--error", error, "pixels");
  program.add_option("--views", views);
  program.add_option("--width", width);
  program.add_option("--height", height);
  program.add_option("--threads", threads);
  program.add_option("--cache", cache, "MiB");
  CLI11_PARSE(program, argc, argv);

  const packs::PackReader pack(path);
  const scenes::FarthestPoints farthest = packs::farthest_points(pack);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scenes::Scene scene = pack.scene();
  scenes::Camera camera = scene.cameras.empty()
                              ? scenes::camera_around(farthest, "iso", scene.z_up, aspect)
                              : scene.cameras.front();
  const auto shader = std::make_shared<const shading::Shader>(shading::make_shader(scene));
  raster::RenderOptions options;
  options.width = width;
  options.height = height;
  std::map<int, std::size_t> pixels;  // by how far they are displaced
  comm::run_threads(1, threads, [&](comm::Communicator& communicator) {
    raster::Renderer renderer(pack, scene, {std::uint64_t{cache} << 20}, shader);
    for (const scenes::Camera& view_camera : scenes::turntable(camera, views)) {
      std::vector<raster::Result> results;
      std::vector<double> seconds;
      for (const double most : {0.0, error}) {
        options.error = most;
        for (int turn = 0; turn < 2; ++turn) {
          if (turn > 0) results.pop_back();
          seconds.push_back(bench::seconds_of([&] {
            results.push_back(renderer.render(communicator, view_camera, options));
            return 0;
          }));
        }
      }
      const scenes::View view = scenes::make_view(view_camera, width, height);
      const auto& a = std::get<image::Image8>(results[0].picture);
      const auto& b = std::get<image::Image8>(results[1].picture);
      std::map<int, std::size_t> own;
      for (int y = kFarthest; y + kFarthest < height; ++y) {
        for (int x = kFarthest; x + kFarthest < width; ++x)
          ++own[std::max(displaced_by(a, b, view, x, y), displaced_by(b, a, view, x, y))];
      }
      const auto triangles = [](const raster::Result& result) {
        std::uint64_t sum = 0;
        for (const std::uint64_t level : result.statistics.pack->levels) sum += level;
        return static_cast<unsigned long long>(sum);
      };
      std::printf("exact %9llu triangles %7.1f ms, error %.2f %9llu triangles %7.1f ms, levels",
                  triangles(results[0]), seconds[1] * 1e3, error, triangles(results[1]),
                  seconds[3] * 1e3);
      const auto& levels = results[1].statistics.pack->levels;
      const auto coarsest =
          std::find_if(levels.rbegin(), levels.rend(), [](auto n) { return n > 0; });
      for (const std::uint64_t level : std::span(levels.begin(), coarsest.base()))
        std::printf(" %llu", static_cast<unsigned long long>(level));
      std::printf("\n");
      for (const auto& [distance, count] : own) pixels[distance] += count;
    }
  });
  for (const auto& [distance, count] : pixels)
    std::printf("displaced by %d: %zu pixels\n", distance, count);
}
