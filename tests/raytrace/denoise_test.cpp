#include "raytrace/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "comm/threads.h"
#include "raytrace/progressive.h"
#include "scenes/generate.h"

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

float channel(const image::RgbaF& c, int k) { return k == 0 ? c.r : k == 1 ? c.g : c.b; }

// By how much channels leave the range that the picture had before within two pixels.
float out_of_range(const image::ImageF& before, const image::ImageF& after) {
  float most = 0.0F;
  for (int y = 0; y < after.height; ++y) {
    for (int x = 0; x < after.width; ++x) {
      for (int k = 0; k < 3; ++k) {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (int j = std::max(0, y - 2); j <= std::min(after.height - 1, y + 2); ++j) {
          for (int i = std::max(0, x - 2); i <= std::min(after.width - 1, x + 2); ++i) {
            const float v =
                channel(before.colour[static_cast<std::size_t>(j * after.width + i)], k);
            low = std::min(low, v);
            high = std::max(high, v);
          }
        }
        const float v = channel(after.colour[static_cast<std::size_t>(y * after.width + x)], k);
        most = std::max({most, low - v, v - high});
      }
    }
  }
  return most;
}

glm::dvec3 energy(const image::ImageF& picture) {
  glm::dvec3 sum(0.0);
  for (const image::RgbaF& c : picture.colour.span()) sum += glm::dvec3(c.r, c.g, c.b);
  return sum;
}

image::ImageF copy(const image::ImageF& picture) {
  image::ImageF result(picture.width, picture.height);
  std::copy_n(picture.colour.data(), picture.pixels(), result.colour.data());
  std::copy_n(picture.depth.data(), picture.pixels(), result.depth.data());
  return result;
}

// Leaves: next to no blue in their albedo, and light of the sky that they mirror.
TEST(Denoise, DarkAlbedosDoNotMultiplyLight) {
  constexpr int kSide = 32;
  image::ImageF picture(kSide, kSide);
  Features features(kSide * kSide);
  std::mt19937 random(2);
  std::normal_distribution<float> normal(0.0F, 0.03F);
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const float off = normal(random);
    features.albedo[i] = {0.1F, 0.2F, i % 3 == 0 ? 0.019F : 0.025F};
    features.normal[i] = {0, 0, 1};
    picture.colour[i] = {0.15F + off, 0.2F + off, 0.22F + off, 1.0F};
    picture.depth[i] = 1.0F;
  }
  denoise(picture, features, std::vector<float>(picture.pixels(), 0.03F * 0.03F));
  for (const image::RgbaF& c : picture.colour.span()) {
    EXPECT_NEAR(c.r, 0.15F, 0.1F);
    EXPECT_NEAR(c.b, 0.22F, 0.1F);
  }
}

TEST(Denoise, KeepsRangesAndEnergy) {
  for (const float noise : {0.05F, 0.3F, 1.0F}) {
    Scene s = two_walls(noise);
    const image::ImageF before = copy(s.picture);
    denoise(s.picture, s.features, s.variance);
    EXPECT_LE(out_of_range(before, s.picture), 1e-5F);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(energy(s.picture)[k] / energy(before)[k], 1.0, 0.01);
  }
}

TEST(Denoise, TellsUnknownNoiseFromNeighbours) {
  Scene s = two_walls(0.3F);
  const double before = error(s.picture, s.clean);
  denoise(s.picture, s.features, {});
  EXPECT_LT(error(s.picture, s.clean), before / 2);
}

struct Pictures {
  image::ImageF noisy, denoised, reference;
};

Pictures pictures_of(const char* name) {
  const scenes::Scene scene = scenes::generate(name);
  const Tracer tracer = make_tracer(scene);
  ProgressiveOptions options;
  options.frame.width = 48;
  options.frame.height = 32;
  options.frame.samples = 32;
  options.frame.integrator = "path";
  options.frame.trace.background = TraceOptions::Background::transparent;
  options.features = true;
  Pictures result;
  comm::run_threads(1, 2, [&](comm::Communicator& communicator) {
    Renderer renderer(tracer);
    ProgressiveResult few =
        render_progressively(communicator, renderer, scene.cameras.at(0), options);
    result.noisy = copy(few.image);
    denoise(few.image, few.features, variance(few.film));
    result.denoised = std::move(few.image);
    options.features = false;
    options.frame.samples = 1024;
    options.frame.trace.seed = 1;
    result.reference =
        render_progressively(communicator, renderer, scene.cameras.at(0), options).image;
  });
  return result;
}

// Of light as the eye sees it: a tenth is a tenth wherever it is missing.
double relative_error(const image::ImageF& a, const image::ImageF& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double r = channel(b.colour[i], k);
      sum += std::pow(channel(a.colour[i], k) - r, 2) / (r * r + 0.01);
    }
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels())));
}

class DenoisedScene : public testing::TestWithParam<const char*> {};

TEST_P(DenoisedScene, IsCloserToItsReferenceWithinRangesAndOfTheSameEnergy) {
  const Pictures p = pictures_of(GetParam());
  EXPECT_LT(relative_error(p.denoised, p.reference), relative_error(p.noisy, p.reference));
  EXPECT_LE(out_of_range(p.noisy, p.denoised), 1e-5F);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(energy(p.denoised)[k] / energy(p.noisy)[k], 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DenoisedScene,
                         testing::Values("gen:spheres", "gen:cornell", "gen:city:20000"));

}  // namespace
}  // namespace delray::raytrace
