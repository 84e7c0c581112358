#include "raster/pipeline/draw_into_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "parallel/arena.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

// A bumpy square of n x n cells on a wall 2 units before the eye, wider than the frame.
scenes::Mesh wall(std::mt19937& random, std::uint32_t n, float width, float roughness) {
  std::uniform_real_distribution<float> both(-1, 1);
  scenes::Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.positions.emplace_back(
          width * (2.0F * static_cast<float>(i) / static_cast<float>(n) - 1),
          width * (2.0F * static_cast<float>(j) / static_cast<float>(n) - 1),
          -2 + roughness * both(random));
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = j * (n + 1) + i;
      mesh.triangles.emplace_back(v, v + 1, v + n + 2);
      mesh.triangles.emplace_back(v, v + n + 2, v + n + 1);
    }
  }
  return mesh;
}

// Walls fine and coarse, a heap of large and of distant triangles, and a floor that passes below
// the eye; some of them at the same place, mirrored or far to the side.
scenes::Scene walls(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> both(-1, 1);
  scenes::Scene scene;
  scene.materials.resize(2);
  scene.materials[1].double_sided = false;
  scene.meshes.push_back(wall(random, 90, 1.2F, 0.05F));
  scene.meshes.push_back(wall(random, 12, 2.0F, 0.2F));
  scene.meshes.push_back(wall(random, 300, 1.3F, 0.01F));
  scenes::Mesh heap;
  for (int i = 0; i < 500; ++i) {
    const float size = i % 50 == 0 ? 2.0F : 0.02F;
    const glm::vec3 centre(1.5F * both(random), 1.5F * both(random), -3 + 1.5F * both(random));
    for (int k = 0; k < 3; ++k)
      heap.positions.push_back(centre + size * glm::vec3(both(random), both(random), both(random)));
    const std::uint32_t v = 3U * static_cast<std::uint32_t>(i);
    heap.triangles.emplace_back(v, v + 1, v + 2);
    if (i % 7 == 0) heap.triangles.emplace_back(v, v, v + 2);
  }
  scene.meshes.push_back(heap);
  scenes::Mesh floor;
  floor.positions = {{-9, -1, 5}, {9, -1, 5}, {9, -1, -90}, {-9, -1, -90}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(floor);
  scene.meshes[2].material = 1;
  scene.meshes[3].material = 1;
  const auto place = [](const glm::vec3& size, const glm::vec3& origin) {
    glm::mat4x3 m(1.0F);
    for (int k = 0; k < 3; ++k) m[k][k] = size[k];
    m[3] = origin;
    return m;
  };
  scene.instances = {{0, place({1, 1, 1}, {0, 0, 0})},   {1, place({1, 1, 1}, {0.3F, 0, -0.1F})},
                     {0, place({1, 1, 1}, {0, 0, 0})},   {2, place({-1, 1, 1}, {0.1F, 0.2F, -1})},
                     {3, place({1, 1, 1}, {0, 0, 0})},   {2, place({1, 1, 1}, {-0.5F, 0, -0.5F})},
                     {4, place({1, 1, 1}, {0, 0, 0})},   {0, place({2, 1, 1}, {50, 0, 0})},
                     {2, place({1, 1, -1}, {0, 0, -3})}, {3, place({1, 2, 1}, {0, 0, 9})}};
  return scene;
}

struct Setting {
  bool cull = false, skip_hidden = false;
  int threads = 1;
};

// The keys of all tiles' pixels within `regions`; 0 elsewhere.
std::vector<std::int64_t> drawn(const Screen& screen, const scenes::Scene& scene,
                                std::span<const geometry::Rect> regions, const Setting& setting,
                                TriangleCounts& counts) {
  SceneClusters clusters(scene.meshes);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, setting.cull);
  const TileJobs jobs = make_tile_jobs(screen, regions);
  const DrawIntoTiles task{screen,
                           list,
                           draws,
                           jobs.clip,
                           setting.skip_hidden,
                           [](std::size_t, std::uint32_t, int, int) { return true; },
                           {}};
  FrameTiles tiles;
  std::vector<std::unique_ptr<Worker>> workers;
  DeferredTriangles deferred;
  DrawCosts costs;
  std::vector<std::int64_t> keys(static_cast<std::size_t>(screen.width) * screen.height);
  parallel::Arena(setting.threads).execute([&] {
    for (int frame = 0; frame < 2; ++frame) {  // the second finds the memory of the first
      tiles.begin(screen, jobs);
      counts = draw_into_tiles(task, tiles, workers, deferred, costs);
      for (const TileJob& job : jobs.jobs) {
        if (deferred.large.of_tile(job.tile).empty()) continue;
        draw_large(task, 0, deferred.large, {job.tile, tiles.rect(job.tile), tiles.open(job.tile)});
      }
    }
  });
  for (const TileJob& job : jobs.jobs) {
    const geometry::Rect tile = screen.tile(job.tile);
    for (const geometry::Rect& r : jobs.rects_of(job)) {
      for (int y = r.y0; y < r.y1; ++y) {
        for (int x = r.x0; x < r.x1; ++x) {
          keys[y * screen.width + x] =
              tiles.open(job.tile).key[(y - tile.y0) * kTileSize + x - tile.x0];
        }
      }
    }
  }
  return keys;
}

// One triangle after the other into one tile after the other.
std::vector<std::int64_t> expected_keys(const Screen& screen, const scenes::Scene& scene,
                                        bool cull) {
  SceneClusters clusters(scene.meshes);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, cull);
  std::vector<std::int64_t> keys(static_cast<std::size_t>(screen.width) * screen.height, kEmptyKey);
  ScreenVertices vertices;
  for (std::uint32_t k = 0; k < list.clusters.size(); ++k) {
    const Cluster& cluster = list.clusters[k];
    const PreparedDraw& draw = draws[cluster.draw];
    const ClusterBlock& block = list.block_of(cluster);
    transform(draw.to_view, screen, draw.draw->mesh->positions,
              block.vertices_of(block.clusters[cluster.part]), vertices);
    const auto draw_one = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
      for (int y = pixels.y0; y < pixels.y1; ++y) {
        for (int x = pixels.x0; x < pixels.x1; ++x) {
          const int tile_x = x / kTileSize * kTileSize, tile_y = y / kTileSize * kTileSize;
          TileTriangle t;
          if (!make_tile_triangle(triangle, screen, tile_x, tile_y, t) ||
              !covers(t, x - tile_x, y - tile_y))
            continue;
          std::int64_t& key = keys[y * screen.width + x];
          key = std::min(key, key_of(depth_at(t, x - tile_x, y - tile_y), triangle.number));
        }
      }
    };
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
      set_up({screen, draw, block, block.clusters[cluster.part], vertices}, place,
             k << kClusterBits | place, draw_one);
    }
  }
  return keys;
}

// Of one instance of a ball before the eye, clusters of the far side come after those of the near
// one; all of a near ball come before those of a far one.
TEST(DrawIntoTiles, OrderIsNearDrawsFirstAndOfADrawWhatFacesTheEye) {
  const Screen screen = make_screen(plain_view(301, 205));
  scenes::Mesh ball;
  constexpr std::uint32_t kRound = 64, kPatch = 8;
  for (std::uint32_t j = 0; j <= kRound; ++j) {
    for (std::uint32_t i = 0; i < kRound; ++i) {
      const double a = 6.283185307 * i / kRound, b = 3.141592654 * j / kRound;
      ball.positions.emplace_back(std::cos(a) * std::sin(b), std::cos(b),
                                  -std::sin(a) * std::sin(b));
    }
  }
  for (std::uint32_t k = 0; k < kRound * kRound; ++k) {  // patch by patch
    const std::uint32_t patch = k / (kPatch * kPatch), place = k % (kPatch * kPatch);
    const std::uint32_t i = patch % (kRound / kPatch) * kPatch + place % kPatch;
    const std::uint32_t j = patch / (kRound / kPatch) * kPatch + place / kPatch;
    const std::uint32_t v = j * kRound + i, next = j * kRound + (i + 1) % kRound;
    ball.triangles.emplace_back(v, v + kRound, next);
    ball.triangles.emplace_back(next, v + kRound, next + kRound);
  }
  scenes::Scene scene;
  scene.meshes = {ball};
  const float distance[2] = {30, 5};
  for (const float d : distance) {
    glm::mat4x3 m(1.0F);
    m[0] = {0, 0, -2}, m[2] = {2, 0, 0};  // turned and stretched
    m[3] = {0, 0, -d};
    scene.instances.push_back({0, m});
  }
  SceneClusters clusters(scene.meshes);
  const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
  const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<PreparedDraw> draws = prepare_draws(screen, list, shader, false);
  const DrawIntoTiles task{screen, list, draws, screen.frame(), false, {}, {}};
  std::vector<std::uint32_t> all(list.clusters.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::vector<std::uint32_t> order = nearest_first(task, all);
  EXPECT_TRUE(std::is_permutation(order.begin(), order.end(), all.begin(), all.end()));

  int facing = 0, away = 0;
  std::uint32_t last_draw = 1;
  bool turned = false;
  for (const std::uint32_t k : order) {
    const Cluster& cluster = list.clusters[k];
    ASSERT_LE(cluster.draw, last_draw);
    if (cluster.draw != last_draw) turned = false;
    last_draw = cluster.draw;
    // How its triangles, by their planes in the world, are turned to the eye, from -1 to 1.
    float turn = 0;
    const MeshCluster& part = list.block_of(cluster).clusters[cluster.part];
    const glm::mat4x3& m = scene.instances[cluster.draw].transform;
    for (std::uint32_t place = 0; place < part.count; ++place) {
      const glm::uvec3& t = ball.triangles[cluster.first + place];
      const glm::vec3 a = m * glm::vec4(ball.positions[t.x], 1);
      const glm::vec3 b = m * glm::vec4(ball.positions[t.y], 1);
      const glm::vec3 c = m * glm::vec4(ball.positions[t.z], 1);
      const glm::vec3 normal = glm::cross(b - a, c - a);
      const float length = glm::length(normal) * glm::length(a);
      if (length > 0) turn += glm::dot(normal, a) / length / static_cast<float>(part.count);
    }
    const bool faces = turn<-0.4F, turns = turn> 0.4F;  // the rest is undecided
    EXPECT_FALSE(faces && turned) << "cluster " << k;
    turned |= turns;
    facing += faces ? 1 : 0;
    away += turns ? 1 : 0;
  }
  EXPECT_GT(facing, 10);
  EXPECT_GT(away, 10);
}

TEST(DrawIntoTiles, GivesWhatTrianglesOneByOneGive) {
  const Screen screen = make_screen(plain_view(301, 205));
  const geometry::Rect frame = screen.frame();
  for (unsigned seed = 0; seed < 2; ++seed) {
    const scenes::Scene scene = walls(seed);
    for (const bool cull : {false, true}) {
      const std::vector<std::int64_t> expected = expected_keys(screen, scene, cull);
      for (const bool skip_hidden : {false, true}) {
        for (const int threads : {1, 3}) {
          TriangleCounts counts;
          EXPECT_EQ(drawn(screen, scene, {&frame, 1}, {cull, skip_hidden, threads}, counts),
                    expected)
              << "seed " << seed << " cull " << cull << " skip " << skip_hidden << " threads "
              << threads;
          EXPECT_EQ(counts.in, scenes::triangle_count(scene));
          EXPECT_EQ(counts.in, counts.culled + counts.hidden + counts.rasterized);
          EXPECT_EQ(counts.hidden > 0, skip_hidden);
          EXPECT_EQ(counts.clipped, 2U);
        }
      }
    }
  }
}

TEST(DrawIntoTiles, EveryTargetDrawsTheSame) {
  const Screen screen = make_screen(plain_view(150, 100));
  const geometry::Rect frame = screen.frame();
  const scenes::Scene scene = walls(2);
  const std::vector<std::int64_t> expected = expected_keys(screen, scene, true);
  tests::for_each_target([&] {
    TriangleCounts counts;
    EXPECT_EQ(drawn(screen, scene, {&frame, 1}, {true, true, 1}, counts), expected);
  });
}

TEST(DrawIntoTiles, RegionsShowTheirPartOfTheFrame) {
  const Screen screen = make_screen(plain_view(301, 205));
  const geometry::Rect regions[] = {{10, 20, 70, 30}, {100, 3, 101, 180}, {64, 190, 301, 205}};
  const scenes::Scene scene = walls(3);
  std::vector<std::int64_t> expected = expected_keys(screen, scene, false);
  for (int y = 0; y < screen.height; ++y) {
    for (int x = 0; x < screen.width; ++x) {
      if (std::none_of(std::begin(regions), std::end(regions),
                       [&](const geometry::Rect& r) { return r.contains(x, y); }))
        expected[y * screen.width + x] = 0;
    }
  }
  for (const bool skip_hidden : {false, true}) {
    TriangleCounts counts;
    EXPECT_EQ(drawn(screen, scene, regions, {false, skip_hidden, 2}, counts), expected);
  }
}

}  // namespace
}  // namespace delray::raster
