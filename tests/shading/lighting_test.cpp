#include "shading/lighting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace delray::shading {
namespace {

using Kind = scenes::Light::Kind;

TEST(Lighting, PointLightFallsOffWithTheSquare) {
  scenes::Light light;
  light.kind = Kind::point;
  light.colour = {8, 4, 2};
  light.position = {0, 3, 0};
  const Incident got = incident(light, {0, 1, 0});
  EXPECT_EQ(got.direction, glm::vec3(0, 1, 0));
  EXPECT_EQ(got.distance, 2.0F);
  EXPECT_EQ(got.irradiance, glm::vec3(2, 1, 0.5F));
  EXPECT_EQ(incident(light, light.position).irradiance, glm::vec3(0.0F));
}

TEST(Lighting, DirectionalLightComesFromAgainstItsDirection) {
  scenes::Light light;
  light.direction = {0, -2, 0};
  light.colour = {1, 2, 3};
  const Incident got = incident(light, {5, 6, 7});
  EXPECT_EQ(got.direction, glm::vec3(0, 1, 0));
  EXPECT_TRUE(std::isinf(got.distance));
  EXPECT_EQ(got.irradiance, light.colour);
  light.direction = glm::vec3(0.0F);
  EXPECT_EQ(incident(light, {0, 0, 0}).irradiance, glm::vec3(0.0F));
}

TEST(Lighting, AreaLightShinesToOneSideAndConverges) {
  scenes::Light light;
  light.kind = Kind::area;
  light.colour = glm::vec3(10.0F);
  light.position = {-1, 5, -1};
  light.edge_u = {2, 0, 0};
  light.edge_v = {0, 0, 2};  // their cross product points down
  const Incident below = incident(light, {0, 0, 0});
  EXPECT_NEAR(below.direction.y, 1.0F, 1e-6);
  EXPECT_NEAR(below.irradiance.x, 10.0 * 4 / (25 + 4 / M_PI), 1e-4);
  EXPECT_EQ(incident(light, {0, 9, 0}).irradiance, glm::vec3(0.0F));
  const Incident far = incident(light, {0, -995, 0});
  EXPECT_NEAR(far.irradiance.x, 10.0 * 4 / 1e6, 1e-9);
  const Incident slanted = incident(light, {5, 0, 0});
  EXPECT_NEAR(slanted.irradiance.x, 10.0 * 4 * std::sqrt(0.5) / (50 + 4 / M_PI), 1e-4);
}

}  // namespace
}  // namespace delray::shading
