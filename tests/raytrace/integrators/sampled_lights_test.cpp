// Lights with a size and surfaces that glow, as `direct` and `whitted` see them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

constexpr float kRadiance = 3.0F, kAlbedo = 0.8F;

// The part of the light leaving a small element that meets a parallel rectangle a x b, whose middle
// is at height h above it.
double form_factor(double a, double b, double h) {
  const double x = 0.5 * a / h, y = 0.5 * b / h;
  const double u = std::sqrt(1 + x * x), v = std::sqrt(1 + y * y);
  return 4 / (2 * M_PI) * (x / u * std::atan(y / u) + y / v * std::atan(x / v));
}

// A matt floor at height 0, seen from near by from above its middle.
scenes::Scene floor_scene() {
  scenes::Scene scene;
  add(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8})).ior = 1.0F;
  scene.materials.back().base_colour = glm::vec4(glm::vec3(kAlbedo), 1.0F);
  return scene;
}

scenes::Camera above_middle() {
  scenes::Camera camera;
  camera.eye = {0, 0.5F, 0};
  camera.at = {0, 0, 0};
  camera.up = {0, 0, -1};
  camera.vertical_fov = 1.0F;
  return camera;
}

// Faces down from height 1.
scenes::Mesh lamp() { return quad({-0.5F, 1, -1}, {1, 0, 0}, {0, 0, 2}); }

scenes::Light lamp_light() {
  scenes::Light light;
  light.kind = scenes::Light::Kind::area;
  light.colour = glm::vec3(kRadiance);
  light.position = {-0.5F, 1, -1};
  light.edge_u = {1, 0, 0};
  light.edge_v = {0, 0, 2};
  return light;
}

void add_lamp(scenes::Scene& scene) {
  scenes::Material& material = add(scene, lamp());
  material.emission = glm::vec3(kRadiance);
  material.base_colour = glm::vec4(0, 0, 0, 1);
  material.ior = 1.0F;
}

double mean_green(const scenes::Scene& scene, const scenes::Camera& camera,
                  const std::string& integrator, int samples) {
  RenderOptions options = small(32, 32);
  options.integrator = integrator;
  options.samples = samples;
  // Light from lights alone.
  if (integrator == "path") options.trace.depth = options.trace.diffuse_depth = 1;
  const Result result = render_alone(scene, camera, options);
  double sum = 0.0;
  for (const image::RgbaF& c : result.image.colour.span()) sum += c.g;
  return sum / static_cast<double>(result.image.pixels());
}

class SampledLights : public testing::TestWithParam<const char*> {};

TEST_P(SampledLights, GlowIsAsBrightAsTheFormFactorSays) {
  scenes::Scene scene = floor_scene();
  add_lamp(scene);
  const double expected = kAlbedo * kRadiance * form_factor(1, 2, 1);
  EXPECT_NEAR(mean_green(scene, above_middle(), GetParam(), 16), expected, 0.005 * expected);
}

TEST_P(SampledLights, AreaLightsAreAsBrightAsTheFormFactorSays) {
  scenes::Scene scene = floor_scene();
  scene.lights.push_back(lamp_light());
  const double expected = kAlbedo * kRadiance * form_factor(1, 2, 1);
  EXPECT_NEAR(mean_green(scene, above_middle(), GetParam(), 16), expected, 0.005 * expected);
  add_lamp(scene);  // which shows the light, and adds none
  EXPECT_NEAR(mean_green(scene, above_middle(), GetParam(), 16), expected, 0.005 * expected);
}

// One sample and sixteen agree in the mean.
TEST_P(SampledLights, FewSamplesDrawSeveralPoints) {
  scenes::Scene scene = floor_scene();
  add_lamp(scene);
  RenderOptions options = small(16, 16);
  options.integrator = GetParam();
  for (const auto& [samples, points] : {std::pair{1, 4}, {2, 2}, {3, 1}, {16, 1}}) {
    options.samples = samples;
    const Result result = render_alone(scene, above_middle(), options);
    EXPECT_EQ(result.statistics.rays.shadow, 16U * 16U * static_cast<unsigned>(samples * points));
  }
}

// A blocker hides a part of the lamp, so that a penumbra crosses the picture.
TEST_P(SampledLights, AgreeWithPathsOfOneScattering) {
  for (const float roughness : {0.3F, 1.0F}) {
    scenes::Scene scene = floor_scene();
    scene.materials[0].ior = 1.5F;
    scene.materials[0].roughness = roughness;
    add_lamp(scene);
    scenes::Light light = lamp_light();  // beside the lamp, of another colour
    light.position.x += 2.0F;
    light.colour = {1, 2, 3};
    scene.lights.push_back(light);
    add(scene, quad({-0.2F, 0.5F, 0.3F}, {0.7F, 0, 0}, {0, 0, -0.6F}));
    scenes::Camera camera = above_middle();
    camera.eye = {1.0F, 0.45F, 1.5F};
    camera.up = {0, 1, 0};
    camera.vertical_fov = 60.0F;
    const double expected = mean_green(scene, camera, "path", 256);
    EXPECT_NEAR(mean_green(scene, camera, GetParam(), 64), expected, 0.01 * expected) << roughness;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, SampledLights, testing::Values("direct", "whitted"));

TEST(SampledLightsOfPath, AreWhatTheFormFactorSays) {
  scenes::Scene scene = floor_scene();
  add_lamp(scene);
  const double expected = kAlbedo * kRadiance * form_factor(1, 2, 1);
  EXPECT_NEAR(mean_green(scene, above_middle(), "path", 64), expected, 0.01 * expected);
}

// What a mirrored ray meets is no highlight as well.
TEST(SampledLightsInMirrors, GlowCountsOnce) {
  scenes::Scene scene = floor_scene();
  scene.materials[0].metallic = 1.0F;
  scene.materials[0].roughness = 0.0F;
  scene.materials[0].base_colour = glm::vec4(1.0F);
  scenes::Material& sky = add(scene, quad({-9, 1, -9}, {18, 0, 0}, {0, 0, 18}));
  sky.emission = glm::vec3(kRadiance);
  sky.base_colour = glm::vec4(0, 0, 0, 1);
  EXPECT_NEAR(mean_green(scene, above_middle(), "whitted", 4), kRadiance, 0.01);
}

// No sparkles: the light's centre stands for what samples hardly ever find.
TEST(SampledLightsInMirrors, HighlightsOfAreaLightsAreSteady) {
  scenes::Scene scene = floor_scene();
  scene.materials[0].ior = 1.5F;
  scene.materials[0].roughness = 0.0F;
  scene.lights.push_back(lamp_light());
  scenes::Camera camera = above_middle();
  camera.vertical_fov = 20.0F;
  RenderOptions options = small(32, 32);
  options.integrator = "direct";
  options.samples = 16;
  const Result a = render_alone(scene, camera, options);
  options.trace.seed = 1;
  const Result b = render_alone(scene, camera, options);
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    const float one = a.image.colour[i].g, other = b.image.colour[i].g;
    ASSERT_NEAR(one, other, 0.2F * one) << i;
  }
}

}  // namespace
}  // namespace delray::raytrace
