#include "shading/layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shading/shade.h"

namespace delray::shading {
namespace {

Surface floor_of(float clearcoat, float sheen, double roughness) {
  Surface surface;
  surface.base_colour = glm::vec3(1.0F);
  surface.clearcoat = clearcoat;
  surface.clearcoat_roughness = static_cast<float>(roughness);
  surface.sheen_colour = glm::vec3(sheen);
  surface.sheen_roughness = static_cast<float>(roughness);
  return surface;
}

// What a viewer gets from all directions, each of radiance 1.
double directional_albedo(const Surface& surface, double cosine) {
  const glm::vec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
  const Seen seen = seen_from(surface, view);
  constexpr int kRows = 300, kColumns = 120;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double theta = (i + 0.5) / kRows * M_PI / 2;
    for (int j = 0; j < kColumns; ++j) {
      const double t = (j + 0.5) / kColumns, phi = M_PI - M_PI * t * t;
      const glm::dvec3 light(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                             std::cos(theta));
      sum += reflect(surface, seen, glm::vec3(light)).x * std::sin(theta) * 2 * t;
    }
  }
  return sum * M_PI * M_PI / (kRows * kColumns);
}

TEST(Layers, WhiteSurfacesBelowThemLoseNothing) {
  for (int r = 1; r <= 10; ++r) {
    for (const double cosine : {1.0, 0.8, 0.5, 0.25, 0.1}) {
      for (const float clearcoat : {0.0F, 0.5F, 1.0F}) {
        for (const float sheen : {0.0F, 1.0F}) {
          EXPECT_NEAR(directional_albedo(floor_of(clearcoat, sheen, r / 10.0), cosine), 1.0, 0.02)
              << clearcoat << " " << sheen << " " << r << " " << cosine;
        }
      }
    }
  }
}

TEST(Layers, BlackBelowThemShowsWhatTheyReflect) {
  for (int r = 1; r <= 10; ++r) {
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const glm::vec3 view(std::sqrt(1 - cosine * cosine), 0, cosine);
      Surface coat = floor_of(1.0F, 0.0F, r / 10.0);
      coat.base_colour = glm::vec3(0.0F);
      coat.specular = 0.0F;
      EXPECT_NEAR(directional_albedo(coat, cosine), layers(coat, view).coat_albedo, 0.02);
      Surface sheen = floor_of(0.0F, 1.0F, r / 10.0);
      sheen.base_colour = glm::vec3(0.0F);
      sheen.specular = 0.0F;
      EXPECT_NEAR(directional_albedo(sheen, cosine), layers(sheen, view).sheen_albedo.x, 0.02);
      EXPECT_LE(layers(sheen, view).sheen_albedo.x, 1.0F);
    }
  }
}

TEST(Layers, CoatDarkensTheGlowBelowIt) {
  const Surface surface = floor_of(1.0F, 0.0F, 0.0);
  const Layers seen = layers(surface, {0, 0, 1});
  EXPECT_NEAR(seen.below_coat, 0.96F, 1e-3F);
  EXPECT_LT(layers(surface, {std::sqrt(0.99F), 0, 0.1F}).below_coat, 0.5F);
}

TEST(Layers, CoatHasANormalOfItsOwn) {
  Surface surface = floor_of(1.0F, 0.0F, 0.2);
  surface.normal = glm::normalize(glm::vec3(0.5F, 0, 1));
  surface.base_colour = glm::vec3(0.0F);
  surface.specular = 0.0F;
  const glm::vec3 view = glm::normalize(glm::vec3(0.4F, 0, 1));
  const Layers seen = layers(surface, view);
  const float along_its_own = reflect_by_coat(seen, view, {-view.x, 0, view.z});
  EXPECT_GT(along_its_own,
            100 * reflect_by_coat(seen, view, glm::normalize(glm::vec3(1, 0, 0.3F))));
}

TEST(Layers, NoneLeaveEverythingAsItIs) {
  const Layers none = layers(Surface{}, {0, 0, 1});
  EXPECT_EQ(none.below, 1.0F);
  EXPECT_EQ(reflect(none, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}), glm::vec3(0.0F));
}

}  // namespace
}  // namespace delray::shading
