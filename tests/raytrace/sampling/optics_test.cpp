#include "raytrace/sampling/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::raytrace {
namespace {

const glm::vec3 kNormal(0, 0, 1);

TEST(Optics, RefractionObeysSnell) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.01F, 1.0F);
  for (int i = 0; i < 1000; ++i) {
    const float z = unit(random), ratio = 0.5F + unit(random);
    const float sine = std::sqrt(1 - z * z);
    const Refraction got = refracted({sine, 0, z}, kNormal, ratio);
    if (ratio * sine >= 1.0F) {
      EXPECT_EQ(got.reflected, 1.0F) << "seed 3, try " << i;
      continue;
    }
    EXPECT_NEAR(glm::length(got.direction), 1.0F, 1e-5) << "seed 3, try " << i;
    EXPECT_NEAR(got.direction.x, -ratio * sine, 1e-5) << "seed 3, try " << i;
    EXPECT_LT(got.direction.z, 0.0F);
    EXPECT_GE(got.reflected, 0.0F);
    EXPECT_LE(got.reflected, 1.0F);
  }
}

TEST(Optics, FresnelAtNormalIncidenceAndForEqualMedia) {
  EXPECT_NEAR(refracted(kNormal, kNormal, 1 / 1.5F).reflected, 0.04F, 1e-6);
  EXPECT_NEAR(refracted(kNormal, kNormal, 1.5F).reflected, 0.04F, 1e-6);
  const glm::vec3 view = glm::normalize(glm::vec3(1, 1, 0.2F));
  EXPECT_NEAR(refracted(view, kNormal, 1.0F).reflected, 0.0F, 1e-9);
  EXPECT_NEAR(glm::dot(refracted(view, kNormal, 1.0F).direction, -view), 1.0F, 1e-6);
}

TEST(Optics, DirectionsStayOnTheirSide) {
  const glm::vec3 kept = kept_on_side(glm::normalize(glm::vec3(1, 0, -0.3F)), kNormal);
  EXPECT_GT(kept.z, 0.0F);
  EXPECT_NEAR(glm::length(kept), 1.0F, 1e-6);
  const glm::vec3 fine = glm::normalize(glm::vec3(1, 0, 0.3F));
  EXPECT_EQ(kept_on_side(fine, kNormal), fine);
}

}  // namespace
}  // namespace delray::raytrace
