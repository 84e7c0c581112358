// delray render --light, --light-rotation, --light-strength, with the built program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

const std::string kFloor =
    "v -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv 0 0.5 0\nv 0.6 0.5 0\nv 0 1.1 0\n"
    "f 1 2 3 4\nf 5 6 7\n";
const std::string kView = " --size 64x32 --camera 0,0.8,4,0,0.5,0,0,1,0,60 -q ";
const std::string kRender = "delray render floor.obj -o a.exr" + kView;
const std::string kPath = "--engine raytrace --integrator path --spp 16 ";

// Bright on the left, dim on the right, by `radiance`.
void write_light(const Folder& folder, float radiance = 1.0F, int width = 64, int height = 32) {
  image::ImageF picture(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float light = x < width / 2 ? 4.0F * radiance : 0.25F * radiance;
      picture.colour[static_cast<std::size_t>(y * width + x)] = {light, light, light, 1.0F};
      picture.depth[static_cast<std::size_t>(y * width + x)] = 1.0F;
    }
  }
  image::write_image(folder / "light.exr", picture);
}

image::ImageF picture_of(const std::string& options, const Folder& folder) {
  const Ran ran = run(kRender + options, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << options << "\n" << ran.err;
  return image::read_image_float(folder / "a.exr");
}

double mean(const image::ImageF& picture) {
  double sum = 0.0;
  for (const image::RgbaF& c : picture.colour.span()) sum += c.g;
  return sum / static_cast<double>(picture.pixels());
}

class Light : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    folder_.write("floor.obj", kFloor);
    write_light(folder_);
  }
  Folder folder_;
};

TEST_P(Light, APictureIsSeenBehindTheSceneAndTurns) {
  const image::ImageF ahead = picture_of("--light light.exr " + GetParam(), folder_);
  EXPECT_NEAR(ahead.colour[2].g, 4.0F, 0.01F);
  EXPECT_NEAR(ahead.colour[61].g, 0.25F, 0.01F);
  const image::ImageF turned =
      picture_of("--light light.exr --light-rotation 180 " + GetParam(), folder_);
  EXPECT_NEAR(turned.colour[2].g, 0.25F, 0.01F);
  EXPECT_NEAR(turned.colour[61].g, 4.0F, 0.01F);
}

// Without a background what is left is what surfaces reflect.
TEST_P(Light, APictureLightsSurfacesByItsStrength) {
  const std::string options = "--background transparent --light light.exr " + GetParam();
  const double one = mean(picture_of(options, folder_));
  EXPECT_GT(one, 0.05);
  const double twice = mean(picture_of(options + "--light-strength 2", folder_));
  EXPECT_NEAR(twice / one, 2.0, 1e-3);
  write_light(folder_, 0.5F);
  EXPECT_NEAR(mean(picture_of(options, folder_)) / one, 0.5, 1e-3);
}

TEST_P(Light, NoneAddsNothingAndDefaultIsWhatBareScenesGet) {
  const std::string options = "--background transparent " + GetParam();
  EXPECT_EQ(mean(picture_of(options + "--light none", folder_)), 0.0);
  const double bare = mean(picture_of(options, folder_));
  EXPECT_GT(bare, 0.02);
  EXPECT_EQ(mean(picture_of(options + "--light default", folder_)), bare);
  const double half = mean(picture_of(options + "--light default --light-strength 0.5", folder_));
  EXPECT_NEAR(half / bare, 0.5, 1e-3);
}

TEST_P(Light, ABlackPictureIsNoLight) {
  write_light(folder_, 0.0F);
  const std::string options = "--background transparent " + GetParam();
  EXPECT_EQ(mean(picture_of(options + "--light light.exr", folder_)), 0.0);
  EXPECT_EQ(mean(picture_of(options + "--light light.exr --ranks 2", folder_)), 0.0);
  write_light(folder_, 1e-30F);  // so little that nothing of it is left on the way
  EXPECT_LT(mean(picture_of(options + "--light light.exr --light-strength 1e-20", folder_)), 1e-30);
}

INSTANTIATE_TEST_SUITE_P(Renderers, Light,
                         testing::Values("", "--engine raytrace --integrator direct ",
                                         "--engine raytrace ", kPath));

// What lights a scene does not depend on who has it.
TEST(LightOptions, RanksSeeOnePicture) {
  const Folder folder;
  write_light(folder);
  const auto hash = [&](const std::string& before, const std::string& options) {
    const Ran ran = run(before +
                            "delray render gen:terrain:2000 -o a.png --size 48x32 -q --stats "
                            "s.json --light light.exr --engine raytrace " +
                            options,
                        folder.path());
    EXPECT_EQ(ran.exit_code, 0) << options << ran.err;
    return json::parse(folder.read("s.json"))["image"]["hash"].get<std::string>();
  };
  const std::string path = "--integrator path --spp 2 ";
  const std::string whole = hash("", path);
  EXPECT_EQ(hash("", path + "--ranks 3"), whole);
  EXPECT_EQ(hash(mpirun(2), path), whole);
  // The lights are not quite as strong beside each other where no rank knows the whole scene.
  EXPECT_EQ(hash("", "--ranks 2 --data ray"), hash("", ""));
  EXPECT_EQ(hash(mpirun(2), "--data object"), hash("", ""));
}

TEST(LightOptions, BadPicturesAreNamed) {
  const Folder folder;
  folder.write("floor.obj", kFloor);
  folder.write("light.txt", "no picture\n");
  write_light(folder, 1.0F, 64, 64);
  for (const std::string name : {"missing.exr", "light.txt", "light.exr", "."}) {
    const Ran ran = run(kRender + "--light " + name, folder.path());
    EXPECT_EQ(ran.exit_code, 3) << name;
    EXPECT_NE(ran.err.find(name), std::string::npos) << ran.err;
  }
  write_light(folder, 1.0F, 4096, 2048);
  const Ran large = run(kRender + "--light light.exr --memory 60MB", folder.path());
  EXPECT_EQ(large.exit_code, 1) << large.err;
  EXPECT_NE(large.err.find("light.exr"), std::string::npos) << large.err;
}

TEST(LightOptions, WithoutEffectAreRefused) {
  const Folder folder;
  folder.write("floor.obj", kFloor);
  write_light(folder);
  for (const std::string options :
       {"--light-rotation 90", "--light default --light-rotation 90", "--light-strength 2",
        "--light none --light-strength 2", "--light light.exr --light-strength 0",
        "--light light.exr --light-strength 1e-300", "--light default --light-strength 1e39",
        "--light light.exr --engine raytrace --integrator ao", "--light light.exr -o light.exr"}) {
    EXPECT_EQ(run("delray render floor.obj -o a.png" + kView + options, folder.path()).exit_code, 2)
        << options;
  }
  EXPECT_EQ(run("delray render floor.obj -o light.exr --light light.exr", folder.path()).exit_code,
            2);
}

TEST(LightOptions, WhatGlowsAloneIsToldToTheRasterizer) {
  const Folder folder;
  folder.write("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 5 5 5\n");
  folder.write("lamp.obj", "mtllib lamp.mtl\nusemtl lamp\nv 0 1 0\nv 1 1 0\nv 0 1 1\nf 1 2 3\n" +
                               std::string("v -2 0 -2\nv 2 0 -2\nv 0 0 3\nf 4 5 6\n"));
  const std::string render = "delray render lamp.obj -o a.png --size 32x32 ";
  EXPECT_NE(run(render, folder.path()).err.find("--light default"), std::string::npos);
  EXPECT_EQ(run(render + "--light default", folder.path()).err.find("--light default"),
            std::string::npos);
  EXPECT_EQ(run(render + "--engine raytrace", folder.path()).err.find("--light default"),
            std::string::npos);
}

}  // namespace
}  // namespace delray::tests
