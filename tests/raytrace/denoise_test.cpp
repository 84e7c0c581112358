#include "raytrace/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::raytrace {
namespace {

constexpr int kWallWidth = 48, kWallHeight = 40;

struct Scene {
  image::ImageF picture{kWallWidth, kWallHeight}, clean{kWallWidth, kWallHeight};
  Features features{kWallWidth * kWallHeight};
  std::vector<float> variance = std::vector<float>(kWallWidth * kWallHeight, 0.0F);
};

// A striped wall that is lit from the left, and another wall behind; sky above both.
Scene two_walls(float noise) {
  Scene s;
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0.0F, noise);
  for (int y = 0; y < kWallHeight; ++y) {
    for (int x = 0; x < kWallWidth; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * kWallWidth + static_cast<std::size_t>(x);
      const bool sky = y < 6, near = x < kWallWidth / 2;
      const float light = near ? 2.0F - 0.02F * static_cast<float>(x) : 0.5F;
      const glm::vec3 albedo = x / 4 % 2 == 0 ? glm::vec3(0.8F, 0.3F, 0.1F) : glm::vec3(0.4F);
      const glm::vec3 c = sky ? glm::vec3(0.0F) : albedo * light;
      const float off = sky ? 0.0F : normal(random);
      s.clean.colour[i] = {c.x, c.y, c.z, sky ? 0.0F : 1.0F};
      s.picture.colour[i] = {c.x + albedo.x * off, c.y + albedo.y * off, c.z + albedo.z * off,
                             s.clean.colour[i].a};
      s.clean.depth[i] = s.picture.depth[i] = sky ? image::kEmptyDepth : near ? 3.0F : 9.0F;
      if (sky) continue;
      s.features.normal[i] = near ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
      s.features.albedo[i] = albedo;
      const float luminance = 0.2126F * albedo.x + 0.7152F * albedo.y + 0.0722F * albedo.z;
      s.variance[i] = noise * noise * luminance * luminance;
    }
  }
  return s;
}

double error(const image::ImageF& a, const image::ImageF& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    sum += std::pow(a.colour[i].r - b.colour[i].r, 2) + std::pow(a.colour[i].g - b.colour[i].g, 2) +
           std::pow(a.colour[i].b - b.colour[i].b, 2);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels())));
}

TEST(Denoise, SmoothsNoiseAndKeepsEdgesAndTextures) {
  Scene s = two_walls(0.3F);
  const double before = error(s.picture, s.clean);
  denoise(s.picture, s.features, s.variance);
  EXPECT_LT(error(s.picture, s.clean), before / 4);
  // Beside the edge the walls are still 1.5 apart in light.
  for (int y = 10; y < kWallHeight; ++y) {
    const std::size_t i = static_cast<std::size_t>(y) * kWallWidth + kWallWidth / 2;
    EXPECT_GT(s.picture.colour[i - 1].g / s.features.albedo[i - 1].y, 1.2F);
    EXPECT_LT(s.picture.colour[i].g / s.features.albedo[i].y, 0.8F);
  }
}

TEST(Denoise, LeavesWhatHasNoNoise) {
  Scene s = two_walls(0.0F);
  denoise(s.picture, s.features, s.variance);
  EXPECT_LT(error(s.picture, s.clean), 1e-6);
}

TEST(Denoise, LeavesAlphaDepthAndWhatNothingCovers) {
  Scene s = two_walls(0.3F);
  s.picture.colour[3] = {0.7F, 0.1F, 0.2F, 0.0F};
  denoise(s.picture, s.features, s.variance);
  EXPECT_EQ(s.picture.colour[3], (image::RgbaF{0.7F, 0.1F, 0.2F, 0.0F}));
  for (std::size_t i = 0; i < s.picture.pixels(); ++i) {
    ASSERT_EQ(s.picture.depth[i], s.clean.depth[i]);
    ASSERT_EQ(s.picture.colour[i].a, s.clean.colour[i].a);
    ASSERT_TRUE(std::isfinite(s.picture.colour[i].r));
  }
}

TEST(Denoise, SinglePixelsAndRowsAreFine) {
  for (const int width : {1, 7}) {
    image::ImageF picture(width, 1);
    Features features(static_cast<std::size_t>(width));
    for (int i = 0; i < width; ++i) {
      picture.colour[static_cast<std::size_t>(i)] = {1, 2, 3, 1};
      picture.depth[static_cast<std::size_t>(i)] = 1.0F;
      features.normal[static_cast<std::size_t>(i)] = {0, 0, 1};
    }
    denoise(picture, features, std::vector<float>(static_cast<std::size_t>(width), 0.1F));
    EXPECT_NEAR(picture.colour[0].g, 2.0F, 1e-6F);
  }
  image::ImageF none(0, 0);
  denoise(none, Features(0), {});
}

}  // namespace
}  // namespace delray::raytrace
