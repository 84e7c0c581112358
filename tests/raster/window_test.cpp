// A window of a frame has the bytes of the frame there.
#include <gtest/gtest.h>

#include <random>

#include "comm/threads.h"
#include "raster/combinations.h"
#include "raster/render.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/parts.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

constexpr int kWidth = 203, kHeight = 151;

geometry::Rect random_window(std::mt19937& random) {
  const auto below = [&](int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
  };
  const int x0 = below(kWidth), y0 = below(kHeight);
  return {x0, y0, x0 + 1 + below(kWidth - x0), y0 + 1 + below(kHeight - y0)};
}

TEST(Window, HasTheBytesOfTheFrame) {
  std::mt19937 random(std::random_device{}());
  const unsigned seed = static_cast<unsigned>(random());
  SCOPED_TRACE("seed " + std::to_string(seed));
  random.seed(seed);
  for (const bool orthographic : {false, true}) {
    scenes::Camera camera = random_scene_camera();
    if (orthographic) camera.height = 2.5F;
    for (KindOfPicture& kind : kinds_of_picture(kWidth, kHeight)) {
      const Picture whole = rendered(kind.scene, camera, kind.options);
      for (int turn = 0; turn < 3; ++turn) {
        const geometry::Rect window = random_window(random);
        kind.options.window = window;
        EXPECT_TRUE(same_bytes(rendered(kind.scene, camera, kind.options), part_of(whole, window)))
            << kind.name << " " << window.x0 << " " << window.y0 << " " << window.x1 << " "
            << window.y1;
      }
    }
  }
}

TEST(Window, IsSharedOutInEveryWay) {
  std::mt19937 random(29);
  for (const bool transparent : {false, true}) {
    const scenes::Scene scene = transparent ? transparent_scene(23) : random_scene(23);
    RenderOptions base;
    base.width = kWidth;
    base.height = kHeight;
    base.block = 16;
    const Picture whole = rendered(scene, random_scene_camera(), base);
    int ranks = 1;
    for (RenderOptions& options : combinations(base)) {
      if (options.blend == Blend::by_cell) continue;  // whose bytes depend on the ranks
      options.window = random_window(random);
      ranks = ranks % 5 + 1;
      EXPECT_TRUE(same_bytes(rendered(scene, random_scene_camera(), options, ranks),
                             part_of(whole, options.window)))
          << name_of(options) << " " << ranks << " ranks";
    }
  }
}

// What is kept from frame to frame is of the window of the last.
TEST(Window, MayMoveFromFrameToFrame) {
  const scenes::Scene scene = random_scene(24);
  for (const char* strategy : {"sort-first", "sort-middle", "sort-last", "hybrid"}) {
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.strategy = strategy;
    const Picture whole = rendered(scene, random_scene_camera(), options);
    comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
      Renderer renderer(scene);
      for (const geometry::Rect& window : {geometry::Rect{0, 0, 100, 151},
                                           {100, 0, 203, 151},
                                           {100, 0, 203, 151},
                                           {},
                                           {7, 3, 8, 4}}) {
        RenderOptions mine = options;
        mine.window = window;
        const Picture picture = renderer.render(communicator, random_scene_camera(), mine).picture;
        if (communicator.rank() != 0) continue;
        const geometry::Rect shown =
            window.empty() ? geometry::Rect{0, 0, kWidth, kHeight} : window;
        EXPECT_TRUE(same_bytes(picture, part_of(whole, shown))) << strategy << " " << shown.x0;
      }
    });
  }
}

TEST(Window, LiesInTheFrame) {
  const scenes::Scene scene = random_scene(25, 2);
  RenderOptions options;
  options.width = 20;
  options.height = 10;
  for (const geometry::Rect& window :
       {geometry::Rect{0, 0, 21, 10}, {-1, 0, 5, 5}, {3, 3, 3, 5}, {0, 5, 20, 11}, {5, 5, 4, 6}}) {
    options.window = window;
    EXPECT_THROW(rendered(scene, random_scene_camera(), options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace delray::raster
