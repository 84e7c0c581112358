// A picture on a wall of displays.
#include <gtest/gtest.h>

#include "comm/recording.h"
#include "comm/threads.h"
#include "loadbalance/wall.h"
#include "raster/combinations.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/parts.h"
#include "tests/raster/random_scene.h"

namespace delray::raster {
namespace {

const loadbalance::Wall kWall{3, 2, 61, 40, 7, 5};

RenderOptions options_of(const loadbalance::Wall& wall) {
  RenderOptions options;
  options.width = wall.frame().width();
  options.height = wall.frame().height();
  options.block = 16;
  return options;
}

// All displays show what the frame has there.
void expect_shown(const scenes::Scene& scene, const RenderOptions& given, int ranks,
                  const Picture& whole, const std::string& what) {
  RenderOptions options = given;
  options.displays = loadbalance::displays_of(kWall, ranks);
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    Renderer renderer(scene);
    for (int frame = 0; frame < 2; ++frame) {
      const Result result = renderer.render(communicator, random_scene_camera(), options);
      std::size_t k = 0;
      for (const loadbalance::Region& display : options.displays) {
        if (display.owner != communicator.rank()) continue;
        ASSERT_LT(k, result.shown.size()) << what;
        EXPECT_TRUE(same_bytes(result.shown[k++], part_of(whole, display.rect)))
            << what << ", " << ranks << " ranks, display at " << display.rect.x0 << " "
            << display.rect.y0;
      }
      EXPECT_EQ(k, result.shown.size()) << what;
      EXPECT_EQ(result.statistics.ranks.size(), communicator.rank() == 0 ? ranks : 0) << what;
    }
  });
}

TEST(Wall, ShowsThePictureHoweverItIsSharedOut) {
  for (const bool transparent : {false, true}) {
    const scenes::Scene scene = transparent ? transparent_scene(33) : random_scene(33);
    const RenderOptions base = options_of(kWall);
    const Picture whole = rendered(scene, random_scene_camera(), base);
    int ranks = 0;
    for (const RenderOptions& options : combinations(base)) {
      if (options.blend == Blend::by_cell) continue;  // whose bytes depend on the ranks
      ranks = ranks % 8 + 1;
      expect_shown(scene, options, ranks, whole, name_of(options));
    }
  }
}

TEST(Wall, ShowsEveryKindOfPicture) {
  for (const KindOfPicture& kind :
       kinds_of_picture(kWall.frame().width(), kWall.frame().height())) {
    const Picture whole = rendered(kind.scene, random_scene_camera(), kind.options);
    for (const char* strategy : {"sort-last", "sort-first"}) {
      RenderOptions options = kind.options;
      options.strategy = strategy;
      expect_shown(kind.scene, options, 4, whole, kind.name + " " + strategy);
    }
  }
}

TEST(Wall, IsDrawnByTheOwnersOfDisplays) {
  const scenes::Scene scene = random_scene(34);
  RenderOptions options = options_of(kWall);
  const Picture whole = rendered(scene, random_scene_camera(), options);
  options.owners_draw = true;
  for (const char* strategy : {"sort-first", "sort-middle"}) {
    options.strategy = strategy;
    for (const int ranks : {1, 2, 3, 6, 9}) expect_shown(scene, options, ranks, whole, strategy);
  }
}

std::uint64_t most_gathered(const RenderOptions& options, int ranks) {
  const scenes::Scene scene = scenes::generate("gen:city:2000");
  std::vector<std::uint64_t> moved(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    std::vector<comm::Event> events;
    comm::Recording recording(communicator, events);
    Renderer(scene).render(recording, scene.cameras[0], options);
    for (const comm::Event& event : events) {
      const bool travels =
          event.kind == comm::Event::Kind::send || event.kind == comm::Event::Kind::receive;
      if (travels && event.phase == comm::Phase::gather)
        moved[static_cast<std::size_t>(communicator.rank())] += event.amount;
    }
  });
  return *std::ranges::max_element(moved);
}

// A twelfth of the picture goes to each display; none of it where owners draw.
TEST(Wall, SparesTheBusiestRank) {
  const loadbalance::Wall wall{4, 3, 64, 48};
  for (const char* strategy : {"sort-last", "sort-first", "sort-middle", "hybrid"}) {
    RenderOptions options = options_of(wall);
    options.strategy = strategy;
    const std::uint64_t gathered = most_gathered(options, 12);
    options.displays = loadbalance::displays_of(wall, 12);
    EXPECT_LE(2 * most_gathered(options, 12), gathered) << strategy;
    options.owners_draw = true;
    if (std::string(strategy).starts_with("sort-first") ||
        std::string(strategy).starts_with("sort-middle")) {
      EXPECT_LE(50 * most_gathered(options, 12), gathered) << strategy;
    }
  }
}

TEST(Wall, RefusesDisplaysThatNobodyShows) {
  const scenes::Scene scene = random_scene(35, 2);
  RenderOptions options = options_of(kWall);
  const auto refused = [&] {
    EXPECT_THROW(rendered(scene, random_scene_camera(), options, 2), std::invalid_argument);
  };
  options.displays = {{{0, 0, 10, 10}, 2}};
  refused();
  options.displays = {{{0, 0, 1000, 10}, 0}};
  refused();
  options.displays = {{{5, 5, 5, 10}, 0}};
  refused();
  options.displays.clear();
  options.strategy = "sort-first";
  options.owners_draw = true;
  refused();
  options.displays = loadbalance::displays_of(kWall, 2);
  options.strategy = "hybrid";
  refused();
}

}  // namespace
}  // namespace delray::raster
