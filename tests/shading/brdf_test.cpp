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

// The model as the papers write it, in doubles.
glm::dvec3 textbook(const Lobes& lobes, const glm::dvec3& n, const glm::dvec3& v,
                    const glm::dvec3& l) {
  const glm::dvec3 h = glm::normalize(v + l);
  const double n_l = glm::dot(n, l), n_v = glm::dot(n, v), n_h = glm::dot(n, h);
  const double a2 = std::pow(static_cast<double>(lobes.alpha), 2);
  const glm::dvec3 specular(lobes.specular), rise = glm::dvec3(lobes.grazing) - specular;
  const auto schlick = [&](double cosine) { return specular + rise * std::pow(1.0 - cosine, 5); };
  const double distribution = a2 / (M_PI * std::pow(n_h * n_h * (a2 - 1.0) + 1.0, 2));
  const auto lambda = [&](double c) {
    return (std::sqrt(1.0 + a2 * (1.0 / (c * c) - 1.0)) - 1.0) / 2;
  };
  const double masking = 1.0 / (1.0 + lambda(n_l) + lambda(n_v));
  const glm::dvec3 entering = 1.0 / (1.0 - (specular + rise / 21.0));
  const glm::dvec3 diffuse =
      glm::dvec3(lobes.diffuse) / M_PI * entering * (1.0 - schlick(n_l)) * (1.0 - schlick(n_v));
  return (diffuse + schlick(glm::dot(v, h)) * distribution * masking / (4.0 * n_l * n_v)) * n_l;
}

TEST(Brdf, IsTheModelOfThePapers) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.02F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    const Lobes l = lobes(random_surface(random));
    const glm::vec3 v = above(unit(random), 6.0F * unit(random));
    // Near the mirrored direction too, where the highlight is.
    glm::vec3 light = above(unit(random), 6.0F * unit(random));
    if (i % 2 == 0) light = glm::normalize(glm::vec3(-v.x, -v.y, v.z) + light * 0.05F);
    const glm::vec3 got = reflect(l, kNormal, v, light);
    const glm::dvec3 expected = textbook(l, kNormal, v, light);
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(got[k], expected[k], 2e-3 * expected[k] + 1e-6) << "seed 2, try " << i;
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
