// Scenes of which every rank has a part look as they do to a rank that has all of them.
#include <gtest/gtest.h>

#include "comm/threads.h"
#include "raster/combinations.h"
#include "raster/render.h"
#include "raster/strategies.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

constexpr const char* kTerrain = "gen:terrain:5000:3";

RenderOptions small_picture() {
  RenderOptions options;
  options.width = 83;
  options.height = 61;
  return options;
}

TEST(SceneParts, GiveTheWholePicture) {
  const scenes::Scene whole = scenes::generate(kTerrain);
  int turn = 0;
  for (const bool transparent : {false, true}) {
    // Of one rank's part only, so that ranks have to agree on what blends.
    const auto make_transparent = [&](scenes::Mesh& mesh, std::size_t first) {
      for (std::size_t t = 0; transparent && t < mesh.triangles.size(); ++t)
        if (first + t < 500) mesh.colours[mesh.triangles[t].x].a = 0.5F;
    };
    scenes::Scene scene = whole;
    scene.materials[0].alpha = scenes::Material::Alpha::blend;
    // Vertices that several parts have look alike in all.
    scenes::Mesh& mesh = scene.meshes[0];
    std::vector<glm::uvec3> triangles = mesh.triangles;
    scenes::Mesh apart;
    apart.material = mesh.material;
    for (const glm::uvec3& t : triangles) {
      const auto next = static_cast<std::uint32_t>(apart.positions.size());
      for (int k = 0; k < 3; ++k) {
        apart.positions.push_back(mesh.positions[t[k]]);
        apart.normals.push_back(mesh.normals[t[k]]);
        apart.colours.push_back(mesh.colours[t[k]]);
      }
      apart.triangles.emplace_back(next, next + 1, next + 2);
    }
    make_transparent(apart, 0);
    scene.meshes[0] = apart;
    for (const Strategy& strategy : strategies()) {
      if (!strategy.parts) continue;
      for (const int ranks : {1, 2, 4}) {
        RenderOptions options = small_picture();
        options.strategy = strategy.name;
        options.float_pixels = turn % 2 == 1;
        options.lighting = turn % 3 == 0 ? Lighting::gouraud : Lighting::phong;
        options.supersampling = turn % 4 == 0 ? 2 : 1;
        ++turn;
        Picture expected, picture;
        comm::run_threads(1, 1, [&](comm::Communicator& alone) {
          expected = render(alone, scene, whole.cameras[0], options).picture;
        });
        comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
          const auto all = static_cast<std::uint32_t>(apart.triangles.size());
          const auto n = static_cast<std::uint32_t>(ranks);
          const auto k = static_cast<std::uint32_t>(communicator.rank());
          const std::uint32_t begin = all * k / n, end = all * (k + 1) / n;
          scenes::ScenePart part;
          part.scene = scene;
          part.first_triangle = begin;
          part.triangles = all;
          part.scene.meshes[0].triangles.assign(apart.triangles.begin() + begin,
                                                apart.triangles.begin() + end);
          Renderer renderer(communicator, part);
          for (int frame = 0; frame < 2; ++frame) {
            Picture mine = renderer.render(communicator, whole.cameras[0], options).picture;
            if (communicator.rank() == 0) picture = std::move(mine);
          }
        });
        EXPECT_TRUE(same_bytes(picture, expected)) << strategy.name << " " << ranks;
      }
    }
  }
}

TEST(SceneParts, AreRefusedByWhoeverNeedsAll) {
  comm::run_threads(2, 1, [](comm::Communicator& communicator) {
    const scenes::ScenePart part = scenes::generate_part(kTerrain, communicator.rank(), 2);
    Renderer renderer(communicator, part);
    const scenes::Camera camera = part.scene.cameras[0];
    RenderOptions options = small_picture();
    for (const Strategy& strategy : strategies()) {
      options.strategy = strategy.name;
      if (!strategy.parts) {
        EXPECT_THROW(renderer.render(communicator, camera, options), std::invalid_argument);
      }
    }
    options.strategy = "sort-middle";
    options.groups = Groups::two;
    EXPECT_THROW(renderer.render(communicator, camera, options), std::invalid_argument);
    options = small_picture();
    options.blend = Blend::by_cell;
    EXPECT_THROW(renderer.render(communicator, camera, options), std::invalid_argument);
  });
}

}  // namespace
}  // namespace delray::raster
