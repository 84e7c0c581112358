// How even the partitions of the screen are, by what the rasterizer counts: every partition on a
// scene rendered sort-first by so many ranks. A rank's work is what it rasterized, triangles and
// pixels, at the prices of raster::cost_model; over_share is the largest rank's work over
// an equal share of what one rank alone would do, so that triangles drawn by several count.
// Triangles: drawn by all ranks over those of one alone. Pixels: the most that a rank shaded over
// an equal share. Busy: the largest processor time of a rank over the mean. Fitted: the price of a
// triangle, in samples, that fits the ranks' times best.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "bench/ratio.h"
#include "comm/threads.h"
#include "loadbalance/cost_model.h"
#include "loadbalance/partition.h"
#include "raster/render.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"

using namespace delray;

namespace {

raster::Statistics rendered(const scenes::Scene& scene, const scenes::Camera& camera,
                            const std::string& partition, int ranks, int regions_per_rank,
                            raster::Lighting lighting) {
  raster::RenderOptions options;
  options.width = 1920;
  options.height = 1080;
  options.lighting = lighting;
  options.strategy = "sort-first";
  options.partition = partition;
  options.regions_per_rank = regions_per_rank;
  options.travel = raster::Travel::numbers;
  options.skip_hidden_clusters = false;  // which are hidden depends on who came first
  options.report_partition = true;
  const auto shader = std::make_shared<const shading::Shader>(shading::make_shader(scene));
  raster::Statistics statistics;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    raster::Renderer renderer(scene, shader);
    raster::Result result = renderer.render(communicator, camera, options);
    if (communicator.rank() == 0) statistics = std::move(result.statistics);
  });
  return statistics;
}

loadbalance::RasterSample sample_of(const raster::RankStatistics& rank) {
  return {static_cast<double>(rank.triangles), static_cast<double>(rank.shaded), rank.busy};
}

}  // namespace

// [--regions PER_RANK] [--phong] [SCENE ...]
int main(int argc, char** argv) {
  std::vector<std::string> names;
  int regions_per_rank = 1;
  raster::Lighting lighting = raster::Lighting::gouraud;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--regions") == 0 && i + 1 < argc) {
      ++i;
      std::from_chars(argv[i], argv[i] + std::strlen(argv[i]), regions_per_rank);
    } else if (std::strcmp(argv[i], "--phong") == 0) {
      lighting = raster::Lighting::phong;
    } else {
      names.emplace_back(argv[i]);
    }
  }
  if (names.empty()) names = {"gen:field", "gen:city"};
  std::printf("%-22s %5s %-12s %10s %10s %10s %8s %8s %9s %8s\n", "scene", "ranks", "partition",
              "over_share", "predicted", "triangles", "pixels", "busy", "cut ms", "fitted");
  for (const std::string& name : names) {
    std::vector<std::string> warnings;
    scenes::Scene scene =
        name.starts_with("gen:") ? scenes::generate(name) : scenes::load(name, warnings);
    const scenes::Camera camera = scene.cameras.empty()
                                      ? scenes::camera_around(scene, "default", 16.0F / 9)
                                      : scene.cameras[0];
    scenes::complete(scene, camera);
    const raster::Statistics alone = rendered(scene, camera, "mahd", 1, 1, lighting);
    for (const int ranks : {16, 64}) {
      std::vector<loadbalance::RasterSample> samples;
      std::vector<raster::Statistics> all;
      for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
        all.push_back(rendered(scene, camera, partitioner.name, ranks, regions_per_rank, lighting));
        for (const raster::RankStatistics& rank : all.back().ranks)
          samples.push_back(sample_of(rank));
      }
      const loadbalance::RasterCostModel model = raster::cost_model(lighting);
      const loadbalance::RasterCostModel fitted = loadbalance::fit(samples);
      const auto work = [&](const raster::RankStatistics& rank) {
        return model(static_cast<double>(rank.triangles), static_cast<double>(rank.shaded));
      };
      const double share = work(alone.ranks[0]) / ranks;
      for (std::size_t i = 0; i < all.size(); ++i) {
        double largest = 0;
        std::uint64_t triangles = 0, pixels = 0;
        for (const raster::RankStatistics& rank : all[i].ranks) {
          largest = std::max(largest, work(rank));
          triangles += rank.triangles;
          pixels = std::max(pixels, rank.shaded);
        }
        const auto over = [](std::uint64_t a, std::uint64_t b) {
          return static_cast<double>(a) / static_cast<double>(b);
        };
        std::printf("%-22s %5d %-12s %10.3f %10.3f %10.3f %8.3f %8.3f %9.3f %8.2f\n",
                    name.substr(name.rfind('/') + 1).c_str(), ranks,
                    loadbalance::partitioners()[i].name, largest / share,
                    all[i].partition->over_share, over(triangles, alone.ranks[0].triangles),
                    over(pixels * static_cast<std::uint64_t>(ranks), alone.ranks[0].shaded),
                    all[i].imbalance, all[i].partition->seconds * 1e3,
                    fitted.per_triangle / fitted.per_pixel);
        std::fflush(stdout);
        bench::report_ratio(name.substr(name.rfind('/') + 1) + ", " +
                                loadbalance::partitioners()[i].name + ", " + std::to_string(ranks) +
                                " ranks",
                            largest / share);
      }
    }
  }
}
