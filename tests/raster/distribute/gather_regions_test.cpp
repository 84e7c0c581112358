#include "raster/distribute/gather_regions.h"

#include <gtest/gtest.h>

#include <random>

#include "comm/recording.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

// A small thing somewhere in the picture, from frame to frame elsewhere, in memory that is used
// again: what was there before must not be seen.
TEST(GatherRegions, LeaveNothingOfFramesBefore) {
  const scenes::Scene scene = random_scene(20261128, 60);
  std::vector<scenes::Camera> cameras;
  std::mt19937 random(20261129);
  std::uniform_real_distribution<float> both(-1, 1);
  for (int i = 0; i < 7; ++i) {
    scenes::Camera camera = random_scene_camera();
    camera.eye = camera.at + (camera.eye - camera.at) * (i < 4 ? 9.0F : 3.0F);
    camera.at += glm::vec3(both(random), both(random), 0) * (i < 4 ? 6.0F : 2.0F);
    cameras.push_back(camera);
  }
  for (const int samples : {1, 2}) {
    RenderOptions plain;
    plain.width = 283;
    plain.height = 211;
    plain.supersampling = samples;
    std::vector<Picture> expected;
    comm::run_threads(1, 1, [&](comm::Communicator& alone) {
      for (const scenes::Camera& camera : cameras)
        expected.push_back(render(alone, scene, camera, plain).picture);
    });
    std::vector<RenderOptions> ways(7, plain);
    ways[0].strategy = ways[1].strategy = ways[2].strategy = "sort-first";
    ways[1].partition = "kd-split";
    ways[1].regions_per_rank = 3;
    ways[2].partition = "interlaced";
    ways[3].strategy = "sort-middle";
    ways[4].strategy = "hybrid";
    ways[5].strategy = ways[6].strategy = "sort-last";
    ways[6].shade = Shade::composited;
    for (const int ranks : {1, 2, 3, 5}) {
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        Renderer renderer(scene);
        std::mt19937 same(static_cast<unsigned>(ranks));  // on all ranks
        for (int frame = 0; frame < 40; ++frame) {
          const std::size_t camera = same() % cameras.size(), way = same() % ways.size();
          Result result = renderer.render(communicator, cameras[camera], ways[way]);
          if (communicator.rank() == 0) {
            ASSERT_TRUE(same_bytes(result.picture, expected[camera]))
                << ranks << " ranks, frame " << frame << ", way " << way << ", samples " << samples;
          }
          renderer.recycle(std::move(result.picture));
        }
      });
    }
  }
}

TEST(GatherRegions, SendNoPixelsOfEmptyTiles) {
  image::Image8 images[2] = {image::Image8(256, 128), image::Image8(256, 128)};
  const std::size_t seen = 70 * 256 + 200;  // in the lower right one of rank 1's four tiles
  for (image::Image8& image : images) {
    std::fill(image.depth.data(), image.depth.data() + image.depth.size(), image::kEmptyDepth);
    std::fill(image.colour.data(), image.colour.data() + image.colour.size(), image::Rgba8{});
  }
  images[1].colour.data()[seen] = {1, 2, 3, 255};
  images[1].depth.data()[seen] = 0.5F;
  images[0].colour.data()[100 * 256 + 140] = {9, 9, 9, 9};  // of a frame before
  loadbalance::Partition partition;
  partition.regions = {{{0, 0, 128, 128}, 0}, {{128, 0, 256, 128}, 1}};
  std::vector<comm::Event> events[2];
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    const int rank = communicator.rank();
    comm::Recording recording(communicator, events[rank]);
    gather_regions(recording, partition, {64, 4, {}, {}}, images[rank]);
  });
  std::uint64_t bytes = 0;
  for (const comm::Event& event : events[1])
    bytes += event.kind == comm::Event::Kind::send ? event.amount : 0;
  EXPECT_EQ(bytes, 64U * 64 * 8 + 4);
  EXPECT_EQ(images[0].depth.data()[seen], 0.5F);
  EXPECT_EQ(images[0].colour.data()[seen].b, 3);
  EXPECT_EQ(images[0].colour.data()[100 * 256 + 140].a, 0);
}

}  // namespace
}  // namespace delray::raster
