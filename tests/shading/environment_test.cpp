#include "shading/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shading/arithmetic.h"
#include "shading/lanes/gradient.h"

namespace delray::shading {
namespace {

scenes::Environment sky() {
  scenes::Environment environment;
  environment.zenith = {0.2F, 0.4F, 1.0F};
  environment.horizon = {0.9F, 0.8F, 0.7F};
  environment.ground = {0.1F, 0.05F, 0.0F};
  return environment;
}

glm::vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<float> normal;
  return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

// Integral of radiance times the cosine over pi, by a grid of directions.
glm::dvec3 integrate(const Environment& environment, std::span<const Texture> textures,
                     const glm::vec3& normal) {
  constexpr int kRows = 120, kColumns = 240;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kRows; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / kRows, r = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = 2.0 * M_PI * (j + 0.5) / kColumns;
      const glm::vec3 d(r * std::cos(phi), r * std::sin(phi), z);
      const double cosine = glm::dot(d, normal);
      if (cosine > 0) sum += glm::dvec3(radiance(environment, textures, d)) * cosine;
    }
  }
  return sum * (4.0 * M_PI / (kRows * kColumns) / M_PI);
}

TEST(Environment, GradientIsWhatItSays) {
  const Environment environment = make_environment(sky(), {});
  EXPECT_EQ(radiance(environment, {}, {0, 1, 0}), sky().zenith);
  EXPECT_EQ(radiance(environment, {}, {0, -1, 0}), sky().ground);
  EXPECT_EQ(radiance(environment, {}, {1, 0, 0}), sky().horizon);
}

TEST(Environment, DiffuseRadianceOfAGradientIsItsIntegral) {
  const Environment environment = make_environment(sky(), {});
  std::mt19937 random(5);
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 normal = i == 0 ? glm::vec3(0, 1, 0) : random_direction(random);
    const glm::dvec3 exact = integrate(environment, {}, normal);
    const glm::vec3 got = diffuse_radiance(environment, normal);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], exact[k], 1e-3) << "seed 5, direction " << i;
  }
}

TEST(Environment, DiffuseWeightsAreAsAccurateAsStated) {
  for (int i = -1000; i <= 1000; ++i) {
    const double cosine = i / 1000.0, angle = std::acos(cosine), scale = 2.0 / (3.0 * M_PI);
    const GradientWeights got = diffuse_weights(static_cast<float>(cosine));
    const double zenith = scale * (std::sin(angle) + (M_PI - angle) * cosine);
    const double ground = scale * (std::sin(angle) - angle * cosine);
    ASSERT_NEAR(got.zenith, zenith, 4e-7) << cosine;
    ASSERT_NEAR(got.ground, ground, 4e-7) << cosine;
    ASSERT_NEAR(got.horizon, 1.0 - zenith - ground, 8e-7) << cosine;
  }
}

TEST(Environment, TextureIsOriented) {
  scenes::Texture picture;
  picture.width = 4;
  picture.height = 2;
  picture.srgb = false;
  // Columns look back, left, ahead and right of the middle: their centres are at 45 degrees.
  picture.texels.assign(8, {0, 0, 0, 255});
  picture.texels[2] = {255, 0, 0, 255};      // above, ahead and right
  picture.texels[4 + 1] = {0, 255, 0, 255};  // below, ahead and left
  const std::vector<Texture> textures{make_texture(picture)};
  scenes::Environment environment;
  environment.texture = 0;
  const Environment made = make_environment(environment, textures);
  const glm::vec3 right = radiance(made, textures, glm::normalize(glm::vec3(1, 1.41421356F, -1)));
  const glm::vec3 left = radiance(made, textures, glm::normalize(glm::vec3(-1, -1.41421356F, -1)));
  EXPECT_NEAR(right.x, 1.0F, 1e-4);
  EXPECT_NEAR(right.y, 0.0F, 1e-4);
  EXPECT_NEAR(left.y, 1.0F, 1e-4);
}

TEST(Environment, RotationTurnsTheTextureCounterClockwise) {
  scenes::Texture picture;
  picture.width = 8;
  picture.height = 4;
  picture.radiance.assign(32, glm::vec3(0.0F));
  picture.radiance[8 + 4] = glm::vec3(1000.0F);  // ahead and a little right and up
  const std::vector<Texture> textures{make_texture(picture)};
  scenes::Environment environment;
  environment.texture = 0;
  const auto seen = [&](const glm::vec3& direction) {
    return radiance(make_environment(environment, textures), textures, direction).x;
  };
  const float up = std::cos(67.5F * kPi / 180), out = std::sin(67.5F * kPi / 180);
  const auto around = [&](float degrees) {  // from -z towards +x
    const float angle = degrees * kPi / 180;
    return glm::vec3(out * std::sin(angle), up, -out * std::cos(angle));
  };
  for (const float rotation : {0.0F, 90.0F, -45.0F, 725.0F}) {
    environment.rotation = rotation;
    EXPECT_NEAR(seen(around(22.5F - rotation)), 1000.0F, 1.0F) << rotation;
    EXPECT_NEAR(seen(around(22.5F + 90 - rotation)), 0.0F, 1.0F) << rotation;
  }
}

TEST(Environment, HarmonicsOfASmoothTextureAreItsIntegral) {
  scenes::Texture picture;
  picture.width = 64;
  picture.height = 32;
  picture.srgb = false;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double up = std::cos((y + 0.5) / 32 * M_PI);
      const double along = std::sin((y + 0.5) / 32 * M_PI) * std::sin((x + 0.5) / 64 * 2 * M_PI);
      picture.texels.push_back({static_cast<std::uint8_t>(127.5 + 100 * up),
                                static_cast<std::uint8_t>(127.5 + 100 * along), 51, 255});
    }
  }
  const std::vector<Texture> textures{make_texture(picture)};
  for (const glm::vec3 up : {glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, 2, 3)}) {
    scenes::Environment environment;
    environment.texture = 0;
    environment.up = up;
    const Environment made = make_environment(environment, textures);
    EXPECT_NEAR(glm::dot(made.up, made.right), 0.0F, 1e-6);
    std::mt19937 random(6);
    for (int i = 0; i < 6; ++i) {
      const glm::vec3 normal = random_direction(random);
      const glm::dvec3 exact = integrate(made, textures, normal);
      const glm::vec3 got = diffuse_radiance(made, normal);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], exact[k], 0.01) << "seed 6, direction " << i;
    }
  }
}

TEST(Environment, EmptyOneIsBlack) {
  const Environment environment = make_environment({}, {});
  EXPECT_TRUE(environment.black);
  EXPECT_EQ(radiance(environment, {}, {0, 1, 0}, 0.5F), glm::vec3(0.0F));
  EXPECT_EQ(diffuse_radiance(environment, {0, 1, 0}), glm::vec3(0.0F));
  scenes::Environment odd;
  odd.up = glm::vec3(0.0F);
  odd.texture = 17;
  EXPECT_EQ(make_environment(odd, {}).up, glm::vec3(0, 1, 0));
}

}  // namespace
}  // namespace delray::shading
