#include "apps/view/viewers.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace delray::apps::view {
namespace {

// What pages were told.
struct Told : Outlet {
  std::vector<Json> messages;

  void send(PageId, std::string text) override { messages.push_back(Json::parse(text)); }
  void send_frame(PageId, std::uint64_t, std::vector<std::byte>&&) override {}
  void close(PageId, const std::string& why) override { messages.push_back({{"closed", why}}); }
};

const Json kFacts = {{"type", "scene"}, {"origin", {0, 0, 0}}};

// Viewers of a scene, and a page.
class Viewing : public testing::Test {
 protected:
  static constexpr PageId kPage = 1;

  Viewing() {
    viewers_.set_outlet(told_);
    viewers_.opened(kPage);
    say({{"type", "hello"}, {"width", 64}, {"height", 48}, {"options", Json::object()}});
  }
  void say(const Json& message) { viewers_.received(kPage, message.dump()); }
  void set(const std::string& name, const std::string& value) {
    say({{"type", "option"}, {"name", name}, {"value", value}});
  }
  void move(double x, std::uint64_t number) {
    say({{"type", "camera"},
         {"number", number},
         {"moving", false},
         {"eye", {x, 0, 5}},
         {"at", {0, 0, 0}},
         {"up", {0, 1, 0}},
         {"fov", 40},
         {"height", 0},
         {"clip", 0}});
  }
  Task::Kind next() { return viewers_.next(progress_, 0).kind; }
  // As serve() does it, a camera from the x-axis.
  void place() {
    const Task task = viewers_.next(progress_, 0);
    ASSERT_EQ(task.kind, Task::Kind::place);
    scenes::Camera camera;
    camera.eye = {1, 0, 5};
    viewers_.place(task.page, camera, 0);
  }
  // Renders what is due; its stages.
  std::vector<Stage> render_all() {
    std::vector<Stage> stages;
    for (Task task = viewers_.next(progress_, 0); task.kind == Task::Kind::picture;
         task = viewers_.next(progress_, 0)) {
      stages.push_back(task.order.stage);
      viewers_.done(task, 0.01, true);
    }
    return stages;
  }
  std::string colour_by() { return viewers_.shared_request().scene.colour_by; }

  Told told_;
  Viewers viewers_{{"gen:spheres:100"}, {{"--exaggeration", "1"}}, Until::stopped};
  parallel::Progress progress_;
};

TEST_F(Viewing, WhatIsAskedForBeforeLoadingBeginsIsLoaded) {
  set("--color-by", "z");
  viewers_.scene_is_there();  // of a scene that nobody wants any more
  EXPECT_EQ(option_of(viewers_.begin_loading(), "--color-by"), "z");
  EXPECT_EQ(next(), Task::Kind::place) << "neither to be loaded again nor to be taken";
}

TEST_F(Viewing, AReloadComesBeforeWhatWasLoaded) {
  viewers_.begin_loading();
  viewers_.scene_is_there();
  set("--color-by", "z");
  EXPECT_EQ(next(), Task::Kind::reload);
  EXPECT_EQ(next(), Task::Kind::place);
}

TEST_F(Viewing, AFirstSceneThatCannotBeLeavesNothingToLoad) {
  viewers_.begin_loading();
  EXPECT_FALSE(viewers_.refuse_scene("no such file"));
  EXPECT_EQ(told_.messages.back()["text"], "no such file");
}

TEST_F(Viewing, AnotherSceneThatCannotBeLeavesTheFirst) {
  set("--color-by", "z");
  viewers_.begin_loading();
  EXPECT_TRUE(viewers_.refuse_scene("no heights"));
  EXPECT_EQ(colour_by(), "");
  viewers_.begin_loading();
  EXPECT_FALSE(viewers_.refuse_scene("nor is there the first")) << "it would be tried for ever";
}

TEST_F(Viewing, WhatIsAskedForWhileASceneCannotBeLoadedIsLoadedNext) {
  set("--color-by", "z");
  viewers_.begin_loading();
  set("--color-by", "simplex");
  EXPECT_TRUE(viewers_.refuse_scene("no heights"));
  EXPECT_EQ(colour_by(), "simplex");
}

TEST_F(Viewing, OptionsAreInForceOnceTheirSceneIsThere) {
  viewers_.begin_loading();
  set("--color-by", "z");  // while the one without is loaded
  viewers_.set_scene(kFacts, true);
  viewers_.begin_loading();
  viewers_.refuse_scene("no heights");
  EXPECT_EQ(colour_by(), "") << "the scene with it was never there";
  set("--color-by", "simplex");
  viewers_.begin_loading();
  viewers_.set_scene(kFacts, true);
  set("--color-by", "z");
  viewers_.begin_loading();
  viewers_.refuse_scene("no heights");
  EXPECT_EQ(colour_by(), "simplex");
}

TEST_F(Viewing, RanksStayAsTheyWereAskedForWhereASceneCannotBe) {
  set("--color-by", "z");
  viewers_.begin_loading();
  set("--ranks", "3");
  viewers_.refuse_scene("no heights");
  EXPECT_EQ(viewers_.shared_request().launch.ranks, 3);
}

TEST_F(Viewing, SomeOfASceneIsRasterizedAndNoBetter) {
  set("--engine", "raytrace");
  viewers_.begin_loading();
  viewers_.set_scene(kFacts, false);
  place();
  EXPECT_EQ(render_all(), std::vector{Stage::sharp});
  move(2, 1);
  EXPECT_EQ(render_all(), std::vector{Stage::sharp});
  viewers_.set_scene(kFacts, true);
  EXPECT_EQ(render_all(), (std::vector{Stage::sharp, Stage::coarse, Stage::still}));
}

TEST_F(Viewing, ACameraThatNobodyMovedIsPlacedAgainByTheWholeScene) {
  viewers_.begin_loading();
  say({{"type", "view"}, {"name", "top"}});
  viewers_.set_scene(kFacts, false);
  place();
  render_all();
  viewers_.set_scene(kFacts, true);
  const Task task = viewers_.next(progress_, 0);
  EXPECT_EQ(task.kind, Task::Kind::place);
  EXPECT_EQ(task.view, "top");
  viewers_.place(kPage, {}, 0);
  render_all();
  viewers_.set_scene(kFacts, true);
  EXPECT_EQ(next(), Task::Kind::picture) << "once";
}

TEST_F(Viewing, ACameraThatWasMovedStays) {
  viewers_.begin_loading();
  viewers_.set_scene(kFacts, false);
  place();
  move(2, 1);
  viewers_.set_scene(kFacts, true);
  EXPECT_EQ(next(), Task::Kind::picture);
}

}  // namespace
}  // namespace delray::apps::view
