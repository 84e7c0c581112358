// Scenes shared out over ranks: the picture of the whole scene, whatever travels.
#include "raytrace/distribution.h"

#include <gtest/gtest.h>

#include <cstring>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raytrace/render.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

scenes::Scene completed(const char* name) {
  scenes::Scene scene = scenes::generate(name);
  scenes::complete(scene, scene.cameras[0]);
  return scene;
}

Result shared_out(const scenes::Scene& scene, const RenderOptions& options,
                  const Distribution& distribution, const ShareOptions& share, int ranks,
                  int threads) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    SharedScene mine = SharedScene::make(communicator, scene, share);
    Renderer renderer(mine, distribution);
    Result one = renderer.render(communicator, scene.cameras[0], options);
    if (communicator.rank() == 0) result = std::move(one);
  });
  return result;
}

std::size_t different(const Result& a, const Result& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.image.pixels(); ++i)
    count += std::memcmp(&a.image.colour[i], &b.image.colour[i], sizeof(image::RgbaF)) != 0 ||
                     a.image.depth[i] != b.image.depth[i]
                 ? 1
                 : 0;
  return count;
}

class Distributions : public testing::TestWithParam<const char*> {};

TEST_P(Distributions, GiveThePictureOfTheWholeScene) {
  const parallel::AllowThreads allowed(16);
  const scenes::Scene scene = completed(GetParam());
  for (const char* integrator : {"whitted", "path"}) {
    RenderOptions options = small(64, 48);
    options.tile = 16;
    options.trace.depth = 3;
    options.integrator = integrator;
    const Result whole = render_alone(scene, scene.cameras[0], options);
    std::size_t turn = 0;
    for (const Distribution& distribution : distributions()) {
      if (distribution.replicated) continue;
      for (const int ranks : {1, 2, 3, 4, 8}) {
        for (const int threads : {1, 2}) {
          options.schedule =
              loadbalance::schedules()[turn++ % loadbalance::schedules().size()].name;
          ShareOptions share;
          share.deal = turn % 2 == 0 ? ShareOptions::Deal::random : ShareOptions::Deal::neighbours;
          SCOPED_TRACE(std::string(integrator) + ' ' + distribution.name + ' ' + options.schedule +
                       ' ' + std::to_string(ranks) + " x " + std::to_string(threads));
          const Result result = shared_out(scene, options, distribution, share, ranks, threads);
          ASSERT_EQ(result.image.pixels(), whole.image.pixels());
          EXPECT_EQ(different(result, whole), 0U);
          EXPECT_EQ(result.statistics.rays, whole.statistics.rays);
          EXPECT_EQ(result.statistics.degenerate, whole.statistics.degenerate);
          std::uint64_t sent = 0, received = 0;
          for (const RankStatistics& rank : result.statistics.ranks) {
            sent += rank.bytes_sent;
            received += rank.bytes_received;
          }
          EXPECT_EQ(sent, received);
        }
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, Distributions,
                         testing::Values("gen:terrain:4000", "gen:spheres:4000",
                                         "gen:cornell:600"));

}  // namespace
}  // namespace delray::raytrace
