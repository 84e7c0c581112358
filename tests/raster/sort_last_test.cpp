// What sort-last's ranks do in which order.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "comm/ledger.h"
#include "comm/recording.h"
#include "comm/threads.h"
#include "raster/render.h"
#include "tests/raster/kinds_of_picture.h"

namespace delray::raster {
namespace {

struct Recorded {
  Picture picture;
  std::vector<std::vector<comm::Event>> events;  // by rank
};

Recorded recorded(const scenes::Scene& scene, const RenderOptions& options, int ranks) {
  Recorded result;
  result.events.resize(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    comm::Recording recording(communicator,
                              result.events[static_cast<std::size_t>(communicator.rank())]);
    Result mine = render(recording, scene, random_scene_camera(), options);
    if (communicator.rank() == 0) result.picture = std::move(mine.picture);
  });
  return result;
}

bool is_tile(const comm::Event& event) {
  return event.kind == comm::Event::Kind::send && event.phase == comm::Phase::compose;
}

RenderOptions tiles_of(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.scheme = "tiles";
  return options;
}

TEST(SortLast, HandsTilesOverWhileOthersAreShaded) {
  const scenes::Scene scene = random_scene(7);
  for (const int samples : {1, 2}) {
    SCOPED_TRACE(samples);
    RenderOptions options = tiles_of(300 / samples, 500 / samples);
    options.supersampling = samples;
    const Recorded with_tiles = recorded(scene, options, 3);
    for (const std::vector<comm::Event>& events : with_tiles.events) {
      const auto first_tile = std::find_if(events.begin(), events.end(), is_tile);
      const auto last_fragments =
          std::find_if(events.rbegin(), events.rend(), [](const comm::Event& event) {
            return event.kind == comm::Event::Kind::work && event.work == comm::Work::fragments &&
                   event.amount > 0;
          }).base();
      EXPECT_LT(first_tile - events.begin(), last_fragments - events.begin());
    }
    options.scheme = "tree";
    EXPECT_TRUE(same_bytes(with_tiles.picture, recorded(scene, options, 3).picture));
  }
}

TEST(SortLast, SendsNoPixelsOfTilesWithNothing) {
  scenes::Scene scene = random_scene(8, 1);
  scene.instances.resize(1);
  scene.meshes[0].triangles.resize(1);
  const Recorded result = recorded(scene, tiles_of(300, 200), 4);
  for (std::size_t rank = 1; rank < result.events.size(); ++rank) {
    for (const comm::Event& event : result.events[rank]) {
      if (is_tile(event)) {
        EXPECT_EQ(event.amount, sizeof(int)) << "rank " << rank;
      }
    }
  }
}

}  // namespace
}  // namespace delray::raster
