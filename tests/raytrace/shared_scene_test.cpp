// What of a shared scene is at hand from frame to frame, and which pictures that gives.
#include "raytrace/shared_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "parallel/arena.h"
#include "scenes/camera_path.h"
#include "tests/raytrace/shared_out.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

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
