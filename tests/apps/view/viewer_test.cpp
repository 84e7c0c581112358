#include "apps/view/viewer.h"

#include <gtest/gtest.h>

namespace delray::apps::view {
namespace {

Viewer viewer(const Options& options = {}) {
  Viewer made(std::make_shared<const Look>(make_look({"gen:spheres:100"}, options)), options);
  made.resize({1280, 720});
  return made;
}

CameraMessage camera(std::uint64_t number, bool moving) {
  CameraMessage message;
  message.number = number;
  message.moving = moving;
  message.camera.eye = {0, 0, 1.0F + static_cast<float>(number)};
  return message;
}

TEST(Viewer, HasNothingDueWithoutCameraOrSize) {
  Viewer one(std::make_shared<const Look>(make_look({"gen:spheres:100"}, {})), {});
  EXPECT_FALSE(one.next(0));
  one.place({}, 0);
  EXPECT_FALSE(one.next(0));
  one.resize({100, 50});
  ASSERT_TRUE(one.next(0));
  EXPECT_EQ(one.next(0)->width, 100);
}

TEST(Viewer, RestsSharpThenStill) {
  Viewer one = viewer();
  one.place({}, 0);
  for (const Stage stage : {Stage::sharp, Stage::still}) {
    const auto order = one.next(0);
    ASSERT_TRUE(order);
    EXPECT_EQ(order->stage, stage);
    EXPECT_EQ(order->width, 1280);
    one.done(*order, 0.01, true);
  }
  EXPECT_FALSE(one.next(0));
}

TEST(Viewer, RaysBeginCoarseAndGrow) {
  Viewer one = viewer({{"--engine", "raytrace"}});
  one.place({}, 0);
  one.done(*one.next(0), 0.01, true);
  EXPECT_EQ(one.next(0)->stage, Stage::coarse);
  EXPECT_EQ(one.next(0)->width, 320);
  EXPECT_EQ(one.next(0)->request().engine, Engine::raytrace);
  one.done(*one.next(0), 0.01, true);
  EXPECT_EQ(one.next(0)->stage, Stage::still);
  one.done(*one.next(0), 0.01, false);  // it was left
  ASSERT_TRUE(one.next(0));
  EXPECT_EQ(one.next(0)->stage, Stage::still);
  one.done(*one.next(0), 0.01, true);
  EXPECT_FALSE(one.next(0));
}

TEST(Viewer, MovesWithTheNewestCameraOnly) {
  Viewer one = viewer();
  one.move(camera(1, true), 10);
  one.move(camera(2, true), 10.01);
  one.move(camera(3, true), 10.02);
  const auto order = one.next(10.02);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->stage, Stage::moving);
  EXPECT_EQ(order->camera_number, 3U);
  one.done(*order, 0.01, true);
  EXPECT_FALSE(one.next(10.03)) << "the same picture twice";
  ASSERT_GT(one.wait(10.03), 0);
  ASSERT_LT(one.wait(10.03), 1);
  ASSERT_TRUE(one.next(10.031 + one.wait(10.03))) << "held still, it gets sharp";
  EXPECT_EQ(one.next(11)->stage, Stage::sharp);
}

TEST(Viewer, ACameraThatRestsIsSharpAtOnce) {
  Viewer one = viewer();
  one.move(camera(1, true), 10);
  one.move(camera(1, false), 10.01);
  EXPECT_EQ(one.next(10.01)->stage, Stage::sharp);
}

TEST(Viewer, MovingPicturesGetSmallUntilTheyAreQuick) {
  Viewer one = viewer();
  double now = 0;
  int width = 0;
  for (std::uint64_t i = 1; i < 40; ++i, now += 0.05) {
    one.move(camera(i, true), now);
    const auto order = one.next(now);
    ASSERT_TRUE(order);
    width = order->width;
    // A tenth of a second for the whole picture.
    one.done(*order, 0.1 * order->width * order->height / (1280.0 * 720.0), true);
  }
  EXPECT_GE(width, 1280 * 4 / 8);
  EXPECT_LE(width, 1280 * 6 / 8);
  for (std::uint64_t i = 40; i < 80; ++i, now += 0.05) {
    one.move(camera(i, true), now);
    one.done(*one.next(now), 0.001, true);
  }
  one.move(camera(80, true), now);
  EXPECT_EQ(one.next(now)->width, 1280);
}

TEST(Viewer, MovingPicturesStayLargeWhereTheirSizeIsNotWhatTakesTime) {
  Viewer one = viewer();
  double now = 0;
  int width = 0;
  for (std::uint64_t i = 1; i < 200; ++i, now += 0.1) {
    one.move(camera(i, true), now);
    const auto order = one.next(now);
    ASSERT_TRUE(order);
    width = order->width;
    one.done(*order, 0.08 + 0.02 * order->width * order->height / (1280.0 * 720.0), true);
    if (i > 20) {
      ASSERT_EQ(width, 1280) << "picture " << i;
    }
  }
}

TEST(Viewer, WaitsForAPageThatIsBehind) {
  Viewer one = viewer();
  for (std::uint64_t i = 1; i <= 2; ++i) {
    one.move(camera(i, true), 1);
    one.done(*one.next(1), 0.01, true);
    EXPECT_EQ(one.send(1), i);
  }
  one.move(camera(3, true), 1.01);
  EXPECT_FALSE(one.next(1.01));
  one.seen({1});
  EXPECT_TRUE(one.next(1.01));
  one.seen({99});  // more than there were
  EXPECT_EQ(one.send(1.02), 3U);
  one.move(camera(4, true), 1.02);
  EXPECT_TRUE(one.next(1.02));
  one.send(1.03);
  EXPECT_FALSE(one.next(1.03));
  one.move(camera(4, true), 9);
  EXPECT_TRUE(one.next(9)) << "not for ever";
}

TEST(Viewer, HiddenPagesGetNothing) {
  Viewer one = viewer();
  one.place({}, 0);
  one.watch({.visible = false});
  EXPECT_FALSE(one.next(0));
  one.watch({.visible = true});
  EXPECT_TRUE(one.next(0));
}

TEST(Viewer, OrdersOfBeforeDoNotCount) {
  Viewer one = viewer();
  one.place({}, 0);
  const auto order = one.next(0);
  one.resize({640, 360});
  one.done(*order, 0.01, true);
  EXPECT_EQ(one.next(0)->stage, Stage::sharp);
  EXPECT_EQ(one.next(0)->width, 640);
}

TEST(Viewer, LargePagesGetWhatCanBeMade) {
  Viewer one = viewer();
  one.resize({8192, 8192});
  one.place({}, 0);
  EXPECT_LE(one.next(0)->width * one.next(0)->height, 1 << 24);
}

}  // namespace
}  // namespace delray::apps::view
