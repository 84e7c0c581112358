// Pictures of packs beside those of their scenes.
#include "raster/packed/packed_drawing.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "comm/threads.h"
#include "files/error.h"
#include "packs/pack_writer.h"
#include "raster/combinations.h"
#include "scenes/generate.h"
#include "scenes/points.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/support/temporary_folder.h"

namespace delray::raster {
namespace {

Result of_scene(const scenes::Scene& scene, const scenes::Camera& camera,
                const RenderOptions& options) {
  Result result;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    result = render(communicator, scene, camera, options);
  });
  return result;
}

// Two frames: what one leaves behind must not change the next.
Result of_pack(const packs::PackReader& pack, const scenes::Camera& camera,
               const RenderOptions& options, const PackMemory& memory, int ranks, int threads) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Renderer renderer(pack, pack.scene(), memory);
    Result first = renderer.render(communicator, camera, options);
    Result mine = renderer.render(communicator, camera, options);
    if (communicator.rank() != 0) return;
    EXPECT_TRUE(same_bytes(mine.picture, first.picture));
    result = std::move(mine);
  });
  return result;
}

bool reads_pages(const RenderOptions& options) {
  return find_strategy(options.strategy)->packs && options.schedule.empty() &&
         options.blend == Blend::by_owner && !options.count_only;
}

TEST(PackedDrawing, GivesThePictureOfTheSceneHoweverLittleMemoryThereIs) {
  const tests::TemporaryFolder folder;
  int turn = 0;
  for (KindOfPicture& kind : kinds_of_picture(53, 39)) {
    kind.scene =
        kind.name.starts_with("transparent") ? transparent_scene(61, 700) : random_scene(62, 1500);
    packs::write_pack(folder / "a.pack", kind.scene, {.levels = false});
    const packs::PackReader pack(folder / "a.pack");
    const Picture expected = of_scene(kind.scene, random_scene_camera(), kind.options).picture;
    for (const RenderOptions& options : combinations(kind.options)) {
      if (!reads_pages(options) || ++turn % 101 != 0) continue;
      const int ranks = 1 + turn % 4, threads = 1 + turn % 3;
      const PackMemory memory{turn % 2 == 0 ? 0U : 200000U};
      const Result result = of_pack(pack, random_scene_camera(), options, memory, ranks, threads);
      ASSERT_TRUE(same_bytes(result.picture, expected))
          << kind.name << ": " << name_of(options) << " " << ranks << " x " << threads;
      ASSERT_TRUE(result.statistics.pack.has_value());
      EXPECT_GT(result.statistics.pack->clusters, 0U);
    }
  }
  EXPECT_GT(turn, 101 * 8);
}

TEST(PackedDrawing, ReadsOnlyWhatIsInView) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:terrain:200000");
  packs::write_pack(folder / "a.pack", scene, {.levels = false});
  const packs::PackReader pack(folder / "a.pack");
  scenes::Camera camera = scene.cameras.front();
  RenderOptions options;
  options.width = 160;
  options.height = 120;
  const PackMemory memory{std::uint64_t{1} << 30};
  const auto pages_of = [&](const scenes::Camera& from, int ranks) {
    const Result result = of_pack(pack, from, options, memory, ranks, 1);
    EXPECT_TRUE(same_bytes(result.picture, of_scene(scene, from, options).picture));
    return result.statistics.pack->pages;
  };
  const std::uint64_t all = pages_of(camera, 1);
  camera.at = camera.eye + (camera.at - camera.eye) * 0.2F;
  camera.vertical_fov = 8;
  const std::uint64_t few = pages_of(camera, 1);
  EXPECT_LT(few, all / 4);
  EXPECT_EQ(pages_of(camera, 3), few);  // none is read by two ranks of sort-last
  camera.at = camera.eye + glm::vec3(0, 1, 0.1F);
  EXPECT_EQ(pages_of(camera, 3), 0U);
}

// A second frame finds everything in memory where there is enough of it.
TEST(PackedDrawing, CountsWhatItReads) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:city:20000");
  packs::write_pack(folder / "a.pack", scene, {.levels = false});
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 96;
  options.height = 64;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(pack, pack.scene(), {std::uint64_t{1} << 30});
    const packs::CacheCounts first =
        renderer.render(communicator, scene.cameras.front(), options).statistics.pack->cache;
    const packs::CacheCounts second =
        renderer.render(communicator, scene.cameras.front(), options).statistics.pack->cache;
    EXPECT_GT(first.bytes_read, 0U);
    EXPECT_EQ(first.pages_read, first.misses);
    EXPECT_LE(first.stalls, first.misses);
    EXPECT_EQ(second.bytes_read, 0U);
    EXPECT_EQ(second.misses, 0U);
    EXPECT_GT(second.hits, 0U);
  });
}

// Points of one colour each, of all kinds and sizes, some of them twice.
scenes::Scene plain_points(unsigned seed) {
  using Kind = scenes::Shape::Kind;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  scenes::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].unlit = true;
  scene.materials[0].base_colour = {0.9F, 0.7F, 1.0F, 1.0F};
  for (const Kind kind : {Kind::point, Kind::disc, Kind::sphere}) {
    for (const float radius : {0.4F, 2.5F, 30.0F}) {
      scenes::Mesh mesh;
      const int count = radius > 3 ? 20 : 2500;
      for (int i = 0; i < count; ++i) {
        mesh.positions.emplace_back(both(random), both(random), both(random));
        mesh.normals.push_back(glm::normalize(glm::vec3(both(random), both(random), 1)));
        if (kind != Kind::disc)
          mesh.colours.emplace_back(unit(random), unit(random), unit(random), 1.0F);
      }
      scenes::make_points(mesh, {kind, true, radius});
      scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size())});
      scene.meshes.push_back(std::move(mesh));
    }
  }
  glm::mat4x3 beside(1.0F);
  beside[3] = {0.3F, -0.2F, -0.6F};
  scene.instances.push_back({1, beside});
  return scene;
}
scenes::Camera camera_before_points() {
  scenes::Camera camera;
  camera.eye = {0.4F, 0.3F, 3.0F};
  return camera;
}

TEST(PackedDrawing, LooksUpColoursOfPointsBeforeTheirPagesGo) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = plain_points(20261128);
  packs::write_pack(folder / "a.pack", scene, {.levels = false});
  const packs::PackReader pack(folder / "a.pack");
  const scenes::Camera camera = camera_before_points();
  for (const bool one_frame : {false, true}) {
    for (const bool float_pixels : {false, true}) {
      for (const int samples : {1, 2}) {
        RenderOptions options;
        options.width = 150;
        options.height = 110;
        options.supersampling = samples;
        options.float_pixels = float_pixels;
        const Picture expected = of_scene(scene, camera, options).picture;
        for (const int ranks : {1, 3}) {
          options.strategy = ranks == 1 ? "sort-first" : "sort-last";
          const Result result = of_pack(pack, camera, options, {0, one_frame}, ranks, 3);
          EXPECT_TRUE(same_bytes(result.picture, expected)) << float_pixels << samples << ranks;
          EXPECT_EQ(result.statistics.shaded, result.statistics.fragments);
        }
      }
    }
  }
}

TEST(PackedDrawing, ReadsPagesOfPlainPointsOnce) {
  const tests::TemporaryFolder folder;
  std::mt19937 random(20261130);
  std::uniform_real_distribution<float> both(-1, 1);
  constexpr std::uint64_t kPages = 64;  // batches of one thread are of whole pages then
  scenes::Scene scene = plain_points(1);
  scenes::Mesh mesh;
  mesh.positions.resize(kPages * packs::kPageClusters * kClusterTriangles);
  for (glm::vec3& p : mesh.positions) p = {both(random), both(random), both(random)};
  scenes::make_points(mesh, {scenes::Shape::Kind::point, true, 2.0F});
  scene.meshes = {std::move(mesh)};
  scene.instances = {{}};
  packs::write_pack(folder / "a.pack", scene, {.levels = false});
  const packs::PackReader pack(folder / "a.pack");
  const scenes::Camera camera = camera_before_points();
  RenderOptions options;
  options.width = 640;
  options.height = 480;
  const Result result = of_pack(pack, camera, options, {0, true}, 1, 1);
  const PackCounts& counts = *result.statistics.pack;
  EXPECT_EQ(counts.pages, kPages);
  EXPECT_EQ(counts.cache.pages_read, counts.pages - counts.pages_hidden);
}

// With room for all pages colours are looked up in the end, from what is there.
TEST(PackedDrawing, KeepsPagesOfPlainPointsWhereTheyFit) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = plain_points(20261129);
  packs::write_pack(folder / "a.pack", scene, {.levels = false});
  const packs::PackReader pack(folder / "a.pack");
  const scenes::Camera camera = camera_before_points();
  RenderOptions options;
  options.width = 150;
  options.height = 110;
  const Result result = of_pack(pack, camera, options, {std::uint64_t{1} << 30}, 1, 2);
  EXPECT_TRUE(same_bytes(result.picture, of_scene(scene, camera, options).picture));
  EXPECT_EQ(result.statistics.pack->cache.pages_read, 0U);  // of the second frame
}

TEST(PackedDrawing, OfADamagedPackEndsAllRanksWithTheSameError) {
  const tests::TemporaryFolder folder;
  packs::write_pack(folder / "a.pack", scenes::generate("gen:terrain:20000"));
  std::uint64_t offset = 0;
  {
    const packs::PackReader pack(folder / "a.pack");
    offset = pack.pages()[pack.meshes()[0].levels[0].count / 2].offset + 9;
  }
  std::fstream file(folder / "a.pack", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(offset));
  file.put('\x55');
  file.put('\xAA');
  file.close();
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 96;
  options.height = 64;
  for (const char* strategy : {"sort-last", "sort-first"}) {
    options.strategy = strategy;
    for (const int ranks : {1, 3}) {
      EXPECT_THROW(of_pack(pack, pack.scene().cameras.front(), options, {0}, ranks, 2),
                   files::FileError);
    }
  }
}

TEST(PackedDrawing, RefusesStrategiesThatDoNotReadPages) {
  const tests::TemporaryFolder folder;
  packs::write_pack(folder / "a.pack", random_scene(1));
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  for (const Strategy& strategy : strategies()) {
    options.strategy = strategy.name;
    if (strategy.packs) continue;
    EXPECT_THROW(of_pack(pack, random_scene_camera(), options, {}, 1, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace delray::raster
