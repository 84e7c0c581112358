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
    SharedScene mine = SharedScene::make(communicator, scene, share_options(distribution, share));
    Renderer renderer(mine, distribution);
    Result one = renderer.render(communicator, scene.cameras[0], options);
    if (communicator.rank() == 0) result = std::move(one);
  });
  return result;
}

std::size_t different(const Result& a, const Result& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    count += std::memcmp(&a.image.colour[i], &b.image.colour[i], sizeof(image::RgbaF)) != 0 ||
                     a.image.depth[i] != b.image.depth[i]
                 ? 1
                 : 0;
  }
  return count;
}

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

// A process has room for some hundreds of Embree's devices, but not for a thousand.
TEST(SharedScene, ThousandsOfClustersFitIntoAProcess) {
  const scenes::Scene scene = completed("gen:terrain:4000");
  RenderOptions options = small(20, 12);
  options.tile = 16;
  ShareOptions share;
  share.most_triangles = 2;
  const Result whole = render_alone(scene, scene.cameras[0], options);
  const Result result = shared_out(scene, options, *find_distribution("ray"), share, 3, 2);
  EXPECT_EQ(different(result, whole), 0U);
}

// What came is gathered into the resident scene before the next frame, which sends nothing, and in
// which a ray is intersected once, as with a scene that is whole.
TEST(SharedScene, WithRoomForAllOfItLaterFramesAreThoseOfAWholeScene) {
  const scenes::Scene scene = completed("gen:terrain:4000");
  RenderOptions options = small(96, 64);
  options.tile = 16;
  options.integrator = "direct";
  const Result whole = render_alone(scene, scene.cameras[0], options);
  // By frame, of all ranks.
  const auto tests_of = [&](int ranks, std::vector<std::uint64_t>& fetched) {
    std::vector<std::uint64_t> tests;
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      ShareOptions share;
      share.cache_bytes = std::uint64_t{1} << 30;
      SharedScene mine = SharedScene::make(communicator, scene, share);
      Renderer renderer(mine, *find_distribution("object"));
      for (int frame = 0; frame < 5; ++frame) {
        const Result one = renderer.render(communicator, scene.cameras[0], options);
        if (communicator.rank() != 0) continue;
        EXPECT_EQ(different(one, whole), 0U) << frame;
        tests.push_back(0);
        fetched.push_back(0);
        for (const RankStatistics& rank : one.statistics.ranks) {
          tests.back() += rank.tests;
          fetched.back() += rank.clusters_fetched;
        }
      }
    });
    return tests;
  };
  std::vector<std::uint64_t> none, fetched;
  const std::uint64_t once = tests_of(1, none).front();
  const std::vector<std::uint64_t> tests = tests_of(2, fetched);
  EXPECT_EQ(none, std::vector<std::uint64_t>(5, 0));
  EXPECT_GT(fetched.front(), 0U);
  EXPECT_GT(tests.front(), once);
  for (int frame = 1; frame < 5; ++frame) {
    EXPECT_EQ(fetched[frame], 0U) << frame;
    EXPECT_EQ(tests[frame], once) << frame;
  }
}

// Tiles are traced where most of what they show is at hand, whichever rank the schedule gave them.
TEST(SharedScene, FewRaysTravelBetweenNeighbours) {
  const scenes::Scene scene = completed("gen:terrain:40000");
  RenderOptions options = small(192, 128);
  options.tile = 16;
  options.integrator = "direct";
  for (const char* data : {"ray", "hybrid", "ring"}) {
    for (const int ranks : {2, 4}) {
      const Result result =
          shared_out(scene, options, *find_distribution(data), ShareOptions{}, ranks, 1);
      std::uint64_t sent = 0, rays = 0, tiles = 0;
      for (const RankStatistics& rank : result.statistics.ranks) {
        sent += rank.rays_sent;
        rays += rank.rays.primary + rank.rays.shadow;
        tiles += rank.tasks;
      }
      EXPECT_EQ(tiles, 96U) << data;
      EXPECT_GT(sent, 0U) << data << ' ' << ranks;
      // Rays of the ring come to ranks in its order, and so to more of them.
      const std::uint64_t share = std::string_view(data) == "ring" ? 4 : 5;
      EXPECT_LT(sent * share, rays) << data << ' ' << ranks;
    }
  }
}

// A cache that is too small for what a frame needs stays within its limit, frame after frame.
TEST(SharedScene, ASmallCacheGivesTheSamePictureFrameAfterFrame) {
  const scenes::Scene scene = completed("gen:terrain:40000");
  RenderOptions options = small(96, 64);
  options.tile = 16;
  const Result whole = render_alone(scene, scene.cameras[0], options);
  for (const char* data : {"object", "hybrid", "ring", "ray"}) {
    SCOPED_TRACE(data);
    comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
      ShareOptions share;
      share.cache_bytes = std::uint64_t{1} << 19;
      SharedScene mine = SharedScene::make(communicator, scene, share);
      Renderer renderer(mine, *find_distribution(data));
      for (int frame = 0; frame < 4; ++frame) {
        const Result one = renderer.render(communicator, scene.cameras[0], options);
        if (communicator.rank() != 0) continue;
        EXPECT_EQ(different(one, whole), 0U) << frame;
      }
    });
  }
}

// Within a frame clusters may leave the resident scene, but none may join it: rays that have been
// intersected with it before would pass it by.
TEST(SharedScene, NothingBecomesResidentWithinAFrame) {
  const scenes::Scene scene = completed("gen:terrain:8000");
  std::random_device device;
  const unsigned seed = device();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::optional<SharedScene> ranks[2];
  ShareOptions share;
  share.cache_bytes = 200'000;
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    ranks[communicator.rank()].emplace(SharedScene::make(communicator, scene, share));
  });
  SharedScene& mine = *ranks[0];
  std::vector<std::uint32_t> others;
  for (const auto& [number, cluster] : ranks[1]->owned()) others.push_back(number);
  std::sort(others.begin(), others.end());
  std::size_t joined = 0, left = 0;
  for (int frame = 0; frame < 60; ++frame) {
    if (frame % 4 == 0) std::shuffle(others.begin(), others.end(), random);  // another view
    mine.begin_frame();
    std::vector<std::uint8_t> resident(mine.clusters());
    for (std::uint32_t i = 0; i < mine.clusters(); ++i) resident[i] = mine.is_resident(i) ? 1 : 0;
    for (int use = 0; use < 40; ++use) {
      // The first ones most.
      const std::uint32_t cluster = others[random() % (1 + random() % others.size())];
      if (mine.is_resident(cluster)) continue;
      if (mine.find(cluster) == nullptr) {
        mine.expect(cluster);
        mine.put(cluster,
                 unpack_cluster(pack(ranks[1]->owned().at(cluster)->data()).as<std::byte>()));
      }
      mine.note_wanted(cluster, 1000);
      mine.note_tests(1000);
    }
    EXPECT_LE(mine.cached_bytes(), mine.cache_bytes());
    for (const std::uint32_t i : others) {
      ASSERT_LE(mine.is_resident(i), resident[i] != 0) << frame;
      joined += resident[i];
      left += resident[i] != 0 && !mine.is_resident(i) ? 1 : 0;
    }
  }
  EXPECT_GT(joined, 0U);
  EXPECT_GT(left, 0U);
}

// Clusters come and go while the camera turns, and no ray passes one that goes or has just come.
TEST(SharedScene, ASmallCacheGivesTheSamePictureWhileTheCameraTurns) {
  const scenes::Scene scene = completed("gen:spheres:20000");
  RenderOptions options = small(96, 64);
  options.tile = 16;
  options.integrator = "path";
  constexpr int kFrames = 6;
  const std::vector<scenes::Camera> cameras = scenes::turntable(scene.cameras[0], 2 * kFrames);
  std::vector<Result> whole;
  for (int frame = 0; frame < kFrames; ++frame)
    whole.push_back(render_alone(scene, cameras[7 * frame % (2 * kFrames)], options));
  for (const std::uint64_t cache : {200'000, 500'000}) {
    comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
      ShareOptions share;
      share.cache_bytes = cache;
      SharedScene mine = SharedScene::make(communicator, scene, share);
      Renderer renderer(mine, *find_distribution("object"));
      for (int frame = 0; frame < kFrames; ++frame) {
        const Result one =
            renderer.render(communicator, cameras[7 * frame % (2 * kFrames)], options);
        if (communicator.rank() == 0) {
          EXPECT_EQ(different(one, whole[frame]), 0U) << cache << ' ' << frame;
        }
      }
    });
  }
}

// From frame to frame clusters that most rays meet become resident, so that fewer rays are
// intersected with clusters one by one, and the cache stays within its limit.
TEST(SharedScene, ASmallCacheKeepsWhatMostRaysMeet) {
  const scenes::Scene scene = completed("gen:spheres:20000");
  RenderOptions options = small(192, 128);
  options.tile = 16;
  options.integrator = "path";
  std::uint64_t all_bytes = 0;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    all_bytes = SharedScene::make(communicator, scene, {}).bytes();
  });
  std::vector<std::uint64_t> tests, dropped;
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    ShareOptions share;
    share.cache_bytes = all_bytes / 3;
    SharedScene mine = SharedScene::make(communicator, scene, share);
    Renderer renderer(mine, *find_distribution("object"));
    for (int frame = 0; frame < 6; ++frame) {
      const Result one = renderer.render(communicator, scene.cameras[0], options);
      EXPECT_LE(mine.cached_bytes(), mine.cache_bytes()) << frame;
      if (communicator.rank() != 0) continue;
      tests.push_back(0);
      dropped.push_back(0);
      for (const RankStatistics& rank : one.statistics.ranks) {
        tests.back() += rank.tests;
        dropped.back() += rank.clusters_dropped;
      }
    }
  });
  EXPECT_GT(dropped.front(), 0U);
  EXPECT_LT(tests.back() * 10, tests.front() * 9);
}

TEST(SharedScene, NoRankHoldsMoreThanItsPartAndTheCache) {
  constexpr int kRanks = 4;
  const bool full = std::getenv("DELRAY_FULL_TESTS") != nullptr;
  const char* name = full ? "gen:terrain:2000000" : "gen:terrain:40000";
  const scenes::Scene scene = completed(name);
  RenderOptions options = small(96, 64);
  options.tile = 16;
  const Tracer tracer = make_tracer(scene);
  std::uint64_t replicated = tracer.embree.memory();
  for (const scenes::Mesh& mesh : scene.meshes) {
    replicated += mesh.positions.size() * (2 * sizeof(glm::vec3) + sizeof(glm::vec4)) +
                  mesh.triangles.size() * sizeof(glm::uvec3);
  }
  Result whole;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    whole = Renderer(tracer).render(communicator, scene.cameras[0], options);
  });
  EXPECT_EQ(whole.statistics.ranks[0].geometry_bytes, replicated);
  for (const char* data : {"ray", "object", "hybrid", "ring"}) {
    SCOPED_TRACE(data);
    const bool fetches = std::string(data) == "object" || std::string(data) == "hybrid";
    // Percent. Embree takes memory in pieces that are large beside small clusters.
    const std::uint64_t most = full ? 40 : fetches ? 60 : 45;
    Result result;
    comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
      SharedScene mine = SharedScene::make(
          communicator, scenes::generate_part(name, communicator.rank(), kRanks), {});
      Renderer renderer(mine, *find_distribution(data));
      Result one = renderer.render(communicator, scene.cameras[0], options);
      if (communicator.rank() == 0) result = std::move(one);
    });
    EXPECT_EQ(different(result, whole), 0U);
    std::uint64_t fetched = 0, dropped = 0, travelled = 0;
    for (const RankStatistics& rank : result.statistics.ranks) {
      EXPECT_LT(rank.geometry_bytes * 100, replicated * most) << replicated;
      fetched += rank.clusters_fetched;
      dropped += rank.clusters_dropped;
      travelled += rank.rays_sent;
    }
    if (full) continue;  // so few rays are sent rather than so many triangles
    EXPECT_EQ(fetched > 0, fetches);
    if (!fetches) {
      EXPECT_EQ(dropped, 0U);
    } else if (std::string(data) == "object") {
      EXPECT_GT(dropped, 0U);
    }
    EXPECT_EQ(travelled > 0, std::string(data) != "object");
  }
}

}  // namespace
}  // namespace delray::raytrace
