// Scenes shared out over ranks: the picture of the whole scene, whatever travels.
#include "raytrace/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>
#include <string_view>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "loadbalance/schedule.h"
#include "parallel/arena.h"
#include "raytrace/clusters/cluster.h"
#include "raytrace/render.h"
#include "scenes/camera_path.h"
#include "scenes/generate.h"
#include "tests/raytrace/shared_out.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// Clusters that move while rays are on their way are met nevertheless, in this frame and the next.
TEST(Ring, RaysMeetClustersThatMoveMeanwhile) {
  const parallel::AllowThreads allowed(4);
  scenes::Scene scene;
  // What is seen is the first third of it, and only the first rank has that.
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 at(i < 3 ? 0.8F * static_cast<float>(i - 1) : 60.0F, 0, -i);
    add(scene, sphere(16), placed(1.0F, at)).base_colour.a = 0.5F;
    scene.materials.back().alpha = scenes::Material::Alpha::blend;
  }
  scene.cameras.emplace_back();
  scene.cameras[0].eye = {0, 0, 4};
  scenes::complete(scene, scene.cameras[0]);
  RenderOptions options = small(96, 64);
  options.samples = 8;
  options.integrator = "direct";
  const Result whole = render_alone(scene, scene.cameras[0], options);
  std::uint64_t moved = 0;
  for (const std::uint64_t seed : {1, 2}) {
    comm::run_simulated(3, comm::any_order(), seed, [&](comm::Communicator& communicator) {
      ShareOptions share;
      share.most_triangles = 16;
      SharedScene mine = SharedScene::make(communicator, scene, share);
      Renderer renderer(mine, *find_distribution("ring"));
      for (int frame = 0; frame < 3; ++frame) {
        const Result result = renderer.render(communicator, scene.cameras[0], options);
        if (communicator.rank() != 0) continue;
        EXPECT_EQ(different(result, whole), 0U) << seed << ' ' << frame;
        EXPECT_EQ(result.statistics.rays, whole.statistics.rays) << seed << ' ' << frame;
        for (const RankStatistics& rank : result.statistics.ranks) moved += rank.clusters_moved;
      }
    });
  }
  EXPECT_GT(moved, 0U);
}

// A ray through the edge between the ceiling and a wall, which are in different clusters and are
// met in an order that depends on who asks: Embree leaves out hits that are at the very end of
// rays.
TEST(Ring, WhatIsHitAtTheSameDistanceIsDecidedAlikeInAnyOrder) {
  const parallel::AllowThreads allowed(8);
  const scenes::Scene scene = completed("gen:cornell:600");
  RenderOptions options = small(52, 36);
  options.tile = 16;
  const Result whole = render_alone(scene, scene.cameras[0], options);
  ShareOptions share;
  share.assignment = ShareOptions::Assignment::random;
  options.schedule = "demand";
  for (int time = 0; time < 20; ++time) {
    const Result result = shared_out(scene, options, *find_distribution("ring"), share, 4, 2);
    EXPECT_EQ(different(result, whole), 0U) << time;
  }
}

struct Case {
  const char* scene;
  const char* integrator;
};

class Distributions : public testing::TestWithParam<Case> {};

// Every schedule and both assignments come by turns; with DELRAY_FULL_TESTS both numbers of
// threads.
TEST_P(Distributions, GiveThePictureOfTheWholeScene) {
  const parallel::AllowThreads allowed(16);
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  const scenes::Scene scene = completed(GetParam().scene);
  RenderOptions options = small(52, 36);
  options.tile = 16;
  options.trace.depth = 3;
  options.integrator = GetParam().integrator;
  const Result whole = render_alone(scene, scene.cameras[0], options);
  std::size_t turn = 0;
  for (const Distribution& distribution : distributions()) {
    if (distribution.replicated) continue;
    for (const int ranks : {1, 2, 3, 4, 8}) {
      for (int threads = 1; threads <= 2; ++threads) {
        options.schedule = loadbalance::schedules()[turn++ % loadbalance::schedules().size()].name;
        ShareOptions share;
        share.assignment = turn / 2 % 2 == 0 ? ShareOptions::Assignment::random
                                             : ShareOptions::Assignment::neighbours;
        if (!full && (turn + turn / 8) % 2 == 0) continue;
        SCOPED_TRACE(std::string(distribution.name) + ' ' + options.schedule + ' ' +
                     std::to_string(ranks) + " x " + std::to_string(threads));
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
INSTANTIATE_TEST_SUITE_P(Scenes, Distributions,
                         testing::Values(Case{"gen:terrain:4000", "path"},
                                         Case{"gen:cornell:600", "whitted"},
                                         Case{"gen:spheres:4000", "whitted"}),
                         [](const testing::TestParamInfo<Case>& of) {
                           std::string name = of.param.scene;
                           std::replace(name.begin(), name.end(), ':', '_');
                           return name + '_' + of.param.integrator;
                         });

// Nebel's rule: rays to who has fewer, if they are enough; objects else.
TEST(HybridByLoad, SendsRaysToThoseWithFewerAndFetchesElse) {
  const auto decide = find_distribution("hybrid-by-load")->decide;
  WaitingList waiting;
  waiting.rays = 1000;
  waiting.own_load = 500;
  waiting.owner_load = 100;
  waiting.least_load = 50;
  EXPECT_EQ(decide(waiting), RoutingDecision::send_rays);
  waiting.owner_load = 500;
  EXPECT_EQ(decide(waiting), RoutingDecision::fetch_cluster);
  waiting.own_load = waiting.least_load = 10;
  EXPECT_EQ(decide(waiting), RoutingDecision::fetch_cluster);
  waiting.rays = 3;
  EXPECT_EQ(decide(waiting), RoutingDecision::wait);
  waiting.idle = true;
  EXPECT_EQ(decide(waiting), RoutingDecision::fetch_cluster);
}

// Of all ranks, in a frame.
RankCounts counted(const scenes::Scene& scene, const RenderOptions& options, const char* data,
                   const ShareOptions& share, const Result& whole) {
  const Result result = shared_out(scene, options, *find_distribution(data), share, 4, 1);
  EXPECT_EQ(different(result, whole), 0U) << data;
  RankStatistics sum;
  for (RankStatistics rank : result.statistics.ranks) {
    const std::uint64_t clusters = sum.clusters + rank.clusters;
    const std::uint64_t tree = std::max(sum.tree_bytes, rank.tree_bytes);
    sum += std::move(rank);
    sum.clusters = clusters;
    sum.tree_bytes = tree;
  }
  return sum;
}

// Both kinds of messages, and fewer bytes than the worse of the pure schemes.
TEST(HybridByLoad, SendsRaysAndClusters) {
  const scenes::Scene scene = completed("gen:terrain:40000");
  RenderOptions options = small(192, 128);
  options.integrator = "direct";
  const Result whole = render_alone(scene, scene.cameras[0], options);
  ShareOptions share;
  share.assignment = ShareOptions::Assignment::random;
  const RankCounts hybrid = counted(scene, options, "hybrid-by-load", share, whole);
  EXPECT_GT(hybrid.rays_sent, 0U);
  EXPECT_GT(hybrid.clusters_fetched, 0U);
}

// Voxels are compressed on their way, and each is fetched whole.
TEST(PackedVoxels, TravelInFewerBytes) {
  const scenes::Scene scene = completed("gen:terrain:40000");
  const RenderOptions options = small(96, 64);
  const Result whole = render_alone(scene, scene.cameras[0], options);
  const RankCounts packed = counted(scene, options, "packed-voxels", {}, whole);
  EXPECT_GT(packed.clusters_fetched, 0U);
  EXPECT_EQ(packed.rays_sent, 0U);
  const RankCounts object = counted(scene, options, "object", {}, whole);
  const auto bytes_of = [](const RankCounts& counts, std::uint64_t geometry) {
    return static_cast<double>(counts.clusters_fetched_bytes) /
           static_cast<double>(counts.clusters_fetched) /
           (static_cast<double>(geometry) / static_cast<double>(counts.clusters));
  };
  // For a cluster of average size, beside the geometry, which all ranks have together.
  EXPECT_LT(bytes_of(packed, 40000), 0.8 * bytes_of(object, 40000));
}

// The key issue of Caspary and Scherson: cut low, every rank has more of the tree, and the work is
// shared more evenly than with a subtree for each rank.
TEST(CutLevel, TradesWhatIsReplicatedForBalance) {
  const scenes::Scene scene = completed("gen:terrain:40000");
  const RenderOptions options = small(96, 64);
  const Result whole = render_alone(scene, scene.cameras[0], options);
  std::vector<std::uint64_t> clusters, tree_bytes;
  for (const int level : {2, 5, 8, 11}) {
    ShareOptions share;
    share.cut_level = level;
    const RankCounts counts = counted(scene, options, "ray", share, whole);
    clusters.push_back(counts.clusters);
    tree_bytes.push_back(counts.tree_bytes);
    EXPECT_GE(counts.clusters, std::uint64_t{1} << level) << level;
    EXPECT_LE(counts.clusters, std::uint64_t{2} << level) << level;
  }
  EXPECT_TRUE(std::ranges::is_sorted(tree_bytes));
  EXPECT_GT(tree_bytes.back(), 8 * tree_bytes[1]);
}

}  // namespace
}  // namespace delray::raytrace
