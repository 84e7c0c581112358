#include <gtest/gtest.h>

#include <cstring>

#include "comm/collectives.h"
#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

bool same_bytes(const Picture& a, const Picture& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& image) {
        const auto& other = std::get<std::decay_t<decltype(image)>>(b);
        return image.width == other.width && image.height == other.height &&
               std::memcmp(image.colour.data(), other.colour.data(),
                           image.colour.span().size_bytes()) == 0 &&
               std::memcmp(image.depth.data(), other.depth.data(),
                           image.depth.span().size_bytes()) == 0;
      },
      a);
}

struct Drawn {
  Result result;
  comm::Ledger ledger;
};

Drawn drawn(const scenes::Scene& scene, const RenderOptions& options, int ranks, int threads,
            const scenes::Camera& camera = random_scene_camera()) {
  Drawn drawn;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    std::vector<comm::Event> events;
    comm::Recording recording(communicator, events);
    Result result = render(recording, scene, camera, options);
    comm::Ledger ledger = comm::gather_ledger(communicator, events);
    if (communicator.rank() == 0) drawn = {std::move(result), std::move(ledger)};
  });
  return drawn;
}

// Small triangles in many groups, none of which is much of the whole.
scenes::Scene many_groups(bool transparent) {
  scenes::Scene scene = transparent ? transparent_scene(21, 600) : random_scene(21, 600);
  for (scenes::Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
      for (const std::size_t k : {1U, 2U}) {
        mesh.positions[i + k] =
            glm::mix(mesh.positions[i], mesh.positions[i + k], i % 24 == 0 ? 0.3F : 0.8F);
      }
    }
  }
  return scene;
}

RenderOptions hybrid_options(int width, int height) {
  RenderOptions options;
  options.strategy = "hybrid";
  options.width = width;
  options.height = height;
  return options;
}

TEST(Hybrid, OnePictureWhereverGroupsGo) {
  for (const bool transparent : {false, true}) {
    const scenes::Scene scene = many_groups(transparent);
    for (const int samples : {1, 2, 4}) {
      RenderOptions options = hybrid_options(180 / samples, 131 / samples);
      options.supersampling = samples;
      options.float_pixels = samples == 2;
      options.travel = samples == 4 ? Travel::numbers : Travel::geometry;
      const Drawn expected = drawn(scene, options, 1, 1);
      EXPECT_EQ(expected.result.statistics.fragments_travelled, 0U);
      for (int ranks = 2; ranks <= 9; ranks += samples == 1 ? 1 : 3) {
        const Drawn hybrid = drawn(scene, options, ranks, 1 + ranks % 3);
        EXPECT_TRUE(same_bytes(hybrid.result.picture, expected.result.picture))
            << ranks << " ranks, " << samples << " samples, " << transparent;
        EXPECT_GT(hybrid.result.statistics.fragments_travelled, 0U);
      }
    }
  }
}

TEST(Hybrid, SimulatedRanksGiveTheSamePicture) {
  const scenes::Scene scene = many_groups(true);
  const RenderOptions options = hybrid_options(90, 66);
  const Drawn expected = drawn(scene, options, 1, 1);
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Picture picture;
    comm::run_simulated(5, comm::any_order(), seed, [&](comm::Communicator& communicator) {
      Result result = render(communicator, scene, random_scene_camera(), options);
      if (communicator.rank() == 0) picture = std::move(result.picture);
    });
    EXPECT_TRUE(same_bytes(picture, expected.result.picture)) << "seed " << seed;
  }
}

TEST(Hybrid, DrawsNoTriangleTwiceAndCountsWhatTravels) {
  const scenes::Scene scene = many_groups(false);
  RenderOptions options = hybrid_options(180, 131);
  for (const int ranks : {2, 4, 6}) {
    const Drawn hybrid = drawn(scene, options, ranks, 1);
    const Statistics& statistics = hybrid.result.statistics;
    EXPECT_LE(statistics.triangles_in, scenes::triangle_count(scene));
    EXPECT_LE(statistics.triangles_travelled, statistics.triangles_in);
    const comm::Totals compose = comm::totals(hybrid.ledger, comm::Phase::compose);
    EXPECT_EQ(compose.work[static_cast<int>(comm::Work::pixels_composited)],
              statistics.fragments_travelled);
    // Colour, depth, number and position; and what tells of tiles and of messages.
    EXPECT_GE(compose.bytes_sent, 18 * statistics.fragments_travelled);
    EXPECT_LE(compose.bytes_sent, 18 * statistics.fragments_travelled + 12U * 9 * ranks * ranks +
                                      static_cast<unsigned>(2000 * ranks));
  }
}

// A ground of two triangles, in a group of its own.
TEST(Hybrid, DrawsPartsOfWhatIsTooMuchForOneRank) {
  scenes::Scene scene = many_groups(false);
  scenes::Mesh ground;
  ground.positions = {{-99, -1.2F, -99}, {99, -1.2F, -99}, {99, -1.2F, 99}, {-99, -1.2F, 99}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), glm::mat4x3(1)});
  scene.meshes.push_back(ground);
  for (const bool transparent : {false, true}) {
    if (transparent) scene.materials[0].alpha = scenes::Material::Alpha::blend;
    scene.materials[0].base_colour.w = transparent ? 0.5F : 1.0F;
    const RenderOptions options = hybrid_options(300, 200);
    const Drawn expected = drawn(scene, options, 1, 1);
    for (const int ranks : {4, 7}) {
      const Drawn hybrid = drawn(scene, options, ranks, 2);
      EXPECT_TRUE(same_bytes(hybrid.result.picture, expected.result.picture))
          << ranks << " ranks, " << transparent;
    }
  }
}

// Streets of two triangles under everything: one rank that drew them all would send half the frame.
TEST(Hybrid, SendsFewPixelsOfACity) {
  const scenes::Scene scene = scenes::generate("gen:city:50000");
  const RenderOptions options = hybrid_options(320, 180);
  const Drawn one = drawn(scene, options, 1, 1, scene.cameras[0]);
  for (const int ranks : {2, 4}) {
    const Drawn hybrid = drawn(scene, options, ranks, 1, scene.cameras[0]);
    EXPECT_TRUE(same_bytes(hybrid.result.picture, one.result.picture)) << ranks;
    EXPECT_LT(hybrid.result.statistics.fragments_travelled, 320U * 180 * ranks / 20) << ranks;
    EXPECT_LE(hybrid.result.statistics.triangles_in, one.result.statistics.triangles_in);
  }
}

}  // namespace
}  // namespace delray::raster
