// Tiles go to the ranks that have what they show.
#include "raytrace/distributed/tile_owners.h"

#include <gtest/gtest.h>

#include "comm/threads.h"
#include "scenes/camera_path.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// A sphere on the left, in front of another one, and one on the right; nothing between. A rank has
// a sphere.
scenes::Scene three_spheres() {
  scenes::Scene scene;
  add(scene, sphere(20), placed(2.0F, {-6, 0, 0}));
  add(scene, sphere(20), placed(2.0F, {-7, 0, -5}));
  add(scene, sphere(20), placed(2.0F, {6, 0, 0}));
  scene.cameras.emplace_back();
  scene.cameras[0].eye = {0, 0, 8};
  scenes::complete(scene, scene.cameras[0]);
  return scene;
}

// By rank that asks, then tile: 16 x 16 pixels of a picture of 48 x 16.
std::vector<std::vector<int>> owners_of_tiles(int ranks) {
  const scenes::Scene scene = three_spheres();
  RenderOptions options = small(48, 16);
  std::vector<std::vector<int>> owners(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    ShareOptions share;
    share.most_triangles = 1 << 20;
    const SharedScene mine = SharedScene::make(communicator, scene, share);
    const scenes::View view = scenes::make_view(scene.cameras[0], options.width, options.height);
    const shading::BatchShader shader = shading::make_batch_shader(mine.shader());
    const FrameContext context{shader, mine.lights(), view, options.trace};
    IntegratorPool pool(integrator("direct"), context);
    const TiledFrame frame{nullptr, options, context, pool, {{0, 0, 48, 16}, 16, 16}, nullptr};
    for (std::uint32_t tile = 0; tile < 3; ++tile) {
      owners[static_cast<std::size_t>(communicator.rank())].push_back(
          owner_of_tile(frame, mine, communicator.rank(), tile));
    }
  });
  return owners;
}

TEST(TileOwners, HaveTheNearestClusterInTheWay) {
  const std::vector<std::vector<int>> owners = owners_of_tiles(3);
  for (int rank = 0; rank < 3; ++rank) {
    const std::vector<int>& tiles = owners[static_cast<std::size_t>(rank)];
    EXPECT_EQ(tiles, (std::vector<int>{0, rank, 2})) << rank;  // the middle tile shows nothing
  }
}

TEST(TileOwners, AloneARankKeepsAllTiles) {
  EXPECT_EQ(owners_of_tiles(1).front(), (std::vector<int>{0, 0, 0}));
}

}  // namespace
}  // namespace delray::raytrace
