#include "scenes/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "files/error.h"

namespace delray::scenes {
namespace {

std::string file_with(const std::string& text) {
  const std::string path = testing::TempDir() + "camera_path_" +
                           testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt";
  std::ofstream(path) << text;
  return path;
}

TEST(CameraPath, ParsesTenNumbers) {
  const auto camera = parse_camera("11, 2,3,4,5,6,0,1,0, 45.5", {10, 0, 0});
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(camera->at, glm::vec3(-6, 5, 6));
  EXPECT_EQ(camera->up, glm::vec3(0, 1, 0));
  EXPECT_EQ(camera->vertical_fov, 45.5F);
  for (const char* wrong :
       {"", "1,2,3", "1,2,3,4,5,6,7,8,9,10,11", "1,2,3,4,5,6,7,8,9,x", "1,2,3,4,5,6,7,8,9,180",
        "1,2,3,4,5,6,7,8,9,0", "1,2,3,4,5,6,7,8,nan,9", "1,2,3,4,5,6,7,8,,9", "1,2,3,4,5,6,7,8,9,",
        "1,2,3,1,2,3,0,1,0,45", "1,2,3,4,5,6,0,0,0,45"}) {
    EXPECT_FALSE(parse_camera(wrong, {})) << wrong;
  }
}

TEST(CameraPath, TurntableKeepsHeightAndDistance) {
  const Camera camera{{4, 3, 0}, {1, 1, 0}, {0, 2, 0}, 40, 0};
  const auto cameras = turntable(camera, 8);
  ASSERT_EQ(cameras.size(), 8U);
  EXPECT_EQ(cameras[0].eye, camera.eye);
  for (const Camera& turned : cameras) {
    EXPECT_NEAR(turned.eye.y, 3, 1e-6);
    EXPECT_NEAR(glm::distance(turned.eye, camera.at), glm::distance(camera.eye, camera.at), 1e-5);
  }
  EXPECT_LT(glm::distance(cameras[2].eye, glm::vec3(1, 3, -3)), 1e-5F);
  EXPECT_LT(glm::distance(cameras[4].eye, glm::vec3(-2, 3, 0)), 1e-5F);
  EXPECT_EQ(turntable({{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, 40, 0}, 3)[1].eye, glm::vec3(0, 0, 1));
}

TEST(CameraPath, ReadsKeysAndMeetsThem) {
  const auto keys = read_camera_path(
      file_with("# a path\n0,0,10, 0,0,0, 0,1,0, 40\r\n\n4: 4,0,10, 0,0,0, 0,1,0, 60 # wider\n"
                "5,1,10,0,0,0,0,1,0,60"),
      {});
  ASSERT_EQ(keys.size(), 3U);
  EXPECT_EQ(keys[0].frame, 0);
  EXPECT_EQ(keys[1].frame, 4);
  EXPECT_EQ(keys[2].frame, 5);
  const auto cameras = interpolate(keys);
  ASSERT_EQ(cameras.size(), 6U);
  EXPECT_EQ(cameras[0].eye, glm::vec3(0, 0, 10));
  EXPECT_EQ(cameras[4].vertical_fov, 60);
  EXPECT_EQ(cameras[5].eye, glm::vec3(5, 1, 10));
  for (int i = 1; i < 6; ++i) EXPECT_GT(cameras[i].eye.x, cameras[i - 1].eye.x);
}

TEST(CameraPath, StaysStraightBetweenTwoKeys) {
  const Camera a{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 30, 0},
      b{{8, 4, 0}, {8, 4, -1}, {0, 1, 0}, 70, 0};
  const auto cameras = interpolate({{2, a}, {10, b}});
  ASSERT_EQ(cameras.size(), 9U);
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT(glm::distance(cameras[i].eye, b.eye * (static_cast<float>(i) / 8)), 1e-5F) << i;
    EXPECT_NEAR(cameras[i].vertical_fov, 30 + 5 * i, 1e-4);
  }
  EXPECT_EQ(interpolate({{7, a}}).size(), 1U);
}

TEST(CameraPath, NamesTheLineThatIsWrong) {
  const char* const camera = "1,2,3,4,5,6,0,1,0,40\n";
  for (const std::string& text :
       {std::string("\n") + "1,2,3\n", std::string(camera) + "0: " + camera,
        std::string(camera) + "x: " + camera, std::string(camera) + "-1: " + camera,
        std::string(camera) + "2000000: " + camera, std::string("# nothing\n\n")}) {
    try {
      read_camera_path(file_with(text), {});
      FAIL() << text;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_EQ(error.place(), "line 2") << text;
    }
  }
  EXPECT_THROW(read_camera_path("/nowhere/at/all", {}), files::FileError);
}

}  // namespace
}  // namespace delray::scenes
