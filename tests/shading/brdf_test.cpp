#include "shading/brdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::shading {
namespace {

const glm::vec3 kNormal(0, 0, 1);

glm::vec3 above(float z, float phi) {
  const float r = std::sqrt(1.0F - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Surface random_surface(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  Surface surface;
  surface.base_colour = {unit(random), unit(random), unit(random)};
  surface.metallic = unit(random);
  surface.roughness = unit(random);
  surface.ior = 1.0F + unit(random);
  return surface;
}

TEST(Brdf, IsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0.02F, 1.0F);
  for (int i = 0; i < 2000; ++i) {
    const Lobes l = lobes(random_surface(random));
    const glm::vec3 a = above(unit(random), 6.0F * unit(random));
    const glm::vec3 b = above(unit(random), 6.0F * unit(random));
    const glm::vec3 ab = reflect(l, kNormal, a, b) / b.z, ba = reflect(l, kNormal, b, a) / a.z;
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(ab[k], ba[k], 1e-4F * std::max(1.0F, ab[k])) << "seed 1, try " << i;
    }
  }
}

TEST(Brdf, ReflectsNoMoreThanItGets) {
  // White metal and white plastic are the hardest cases.
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.3F, 0.45F, 0.6F, 1.0F}) {
      for (const float cosine : {1.0F, 0.7F, 0.3F, 0.1F}) {
        Surface surface;
        surface.base_colour = glm::vec3(1.0F);
        surface.metallic = metallic;
        surface.roughness = roughness;
        const Lobes l = lobes(surface);
        const glm::vec3 view = above(cosine, 0.0F);
        constexpr int kRows = 300, kColumns = 600;
        double sum = 0;
        for (int i = 0; i < kRows; ++i) {
          for (int j = 0; j < kColumns; ++j) {
            const float phi = static_cast<float>(2 * M_PI * (j + 0.5) / kColumns);
            sum += reflect(l, kNormal, view, above((i + 0.5F) / kRows, phi)).x;
          }
        }
        const double reflected = sum * 2 * M_PI / (kRows * kColumns);
        EXPECT_LE(reflected, 1.01) << metallic << " " << roughness << " " << cosine;
        EXPECT_GE(reflected, 0.3) << metallic << " " << roughness << " " << cosine;
        const double fitted = specular_albedo(l, cosine).x;
        EXPECT_LE(fitted, 1.0);
        if (metallic == 1.0F) {
          EXPECT_NEAR(fitted, reflected, 0.03) << roughness << " " << cosine;
        }
      }
    }
  }
}

TEST(Brdf, LambertianLimitIsAlbedoOverPi) {
  Surface surface;
  surface.base_colour = {0.5F, 0.25F, 1.0F};
  surface.ior = 1.0F;
  const glm::vec3 got = reflect(lobes(surface), kNormal, above(0.4F, 1.0F), above(0.8F, 2.0F));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], surface.base_colour[k] / M_PI * 0.8, 1e-6);
}

TEST(Brdf, BelowTheHorizonIsDark) {
  const Lobes l = lobes(Surface{});
  EXPECT_EQ(reflect(l, kNormal, kNormal, {0, 0, -1}), glm::vec3(0.0F));
  EXPECT_EQ(reflect(l, kNormal, kNormal, {1, 0, 0}), glm::vec3(0.0F));
  const glm::vec3 grazing = reflect(l, kNormal, {1, 0, 0}, {-1, 0, 1e-4F});
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(grazing[k]));
  const glm::vec3 opposite = reflect(l, kNormal, {0, 0, -1}, {0, 0, 1});
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(opposite[k]));
}

TEST(Brdf, BlackMetalAndMatchedGlassReflectNothing) {
  Surface metal;
  metal.base_colour = glm::vec3(0.0F);
  metal.metallic = 1.0F;
  EXPECT_EQ(reflect(lobes(metal), kNormal, kNormal, above(0.3F, 0)), glm::vec3(0.0F));
  Surface glass;
  glass.ior = 1.0F;
  glass.transmission = 1.0F;
  EXPECT_EQ(reflect(lobes(glass), kNormal, above(0.1F, 0), above(0.1F, 3.14F)), glm::vec3(0.0F));
}

}  // namespace
}  // namespace delray::shading
