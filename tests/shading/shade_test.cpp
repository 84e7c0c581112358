#include "shading/shade.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::shading {
namespace {

scenes::Scene scene_with_lights() {
  scenes::Scene scene;
  scene.materials.emplace_back();
  for (int i = 0; i < 3; ++i) {
    scenes::Light light;
    light.direction = {static_cast<float>(i) * 0.3F, -1, 0};
    light.colour = glm::vec3(1.0F + static_cast<float>(i));
    scene.lights.push_back(light);
  }
  return scene;
}

Surface floor_surface() {
  Surface surface;
  surface.normal = surface.geometric_normal = {0, 1, 0};
  return surface;
}

TEST(Shade, AsksForEachLightInOrderAndAddsThemUp) {
  const Shader shader = make_shader(scene_with_lights());
  const Surface surface = floor_surface();
  const glm::vec3 view(0, 1, 0);
  std::vector<std::size_t> asked;
  const glm::vec3 all = shade(shader, surface, view, [&](std::size_t i, const Incident&) {
    asked.push_back(i);
    return 1.0F;
  });
  EXPECT_EQ(asked, (std::vector<std::size_t>{0, 1, 2}));
  glm::vec3 sum(0.0F);
  for (std::size_t only = 0; only < 3; ++only) {
    sum += shade(shader, surface, view, [&](std::size_t i, const Incident&) {
      return glm::vec3(i == only ? 1.0F : 0.0F);
    });
  }
  EXPECT_NEAR(all.x, sum.x, 1e-5);
  EXPECT_GT(all.x, 0.0F);
}

TEST(Shade, LightsBehindTheSurfaceAreNotAskedFor) {
  scenes::Scene scene = scene_with_lights();
  for (scenes::Light& light : scene.lights) light.direction = {0, 1, 0};
  const glm::vec3 colour =
      shade(make_shader(scene), floor_surface(), {0, 1, 0}, [](std::size_t, const Incident&) {
        ADD_FAILURE() << "asked";
        return 1.0F;
      });
  EXPECT_EQ(colour, glm::vec3(0.0F));
}

TEST(Shade, EmissionNeedsNoLight) {
  Surface surface = floor_surface();
  surface.emission = {3, 2, 1};
  const glm::vec3 colour =
      shade(make_shader({}), surface, {0, 1, 0}, [](std::size_t, const Incident&) { return 1.0F; });
  EXPECT_EQ(colour, surface.emission);
}

TEST(Shade, UnlitSurfacesShowTheirColourWhateverTheLight) {
  scenes::Scene scene = scene_with_lights();
  scene.environment.zenith = glm::vec3(2.0F);
  scenes::Material& m = scene.materials[0];
  m.base_colour = {0.25F, 0.5F, 0.75F, 1.0F};
  m.emission = glm::vec3(1.0F);
  m.metallic = 0.5F;
  m.clearcoat = 1.0F;
  m.sheen_colour = glm::vec3(1.0F);
  m.transmission = 1.0F;
  m.unlit = true;
  const Shader shader = make_shader(scene);
  Point point;
  point.colour = {1.0F, 0.5F, 1.0F, 1.0F};
  const glm::vec3 view(0, 0, 1);
  const glm::vec3 colour = shade(shader, evaluate(shader, shader.materials[0], point, view), view,
                                 [](std::size_t, const Incident&) { return 1.0F; });
  EXPECT_EQ(colour, glm::vec3(0.25F, 0.25F, 0.75F));
}

TEST(Shade, ThicknessTakesFromWhatIsSeenThroughGlass) {
  scenes::Scene scene;
  scene.environment.zenith = scene.environment.horizon = scene.environment.ground = glm::vec3(1.0F);
  scenes::Material& glass = scene.materials.emplace_back();
  glass.base_colour = glm::vec4(1.0F);
  glass.transmission = 1.0F;
  glass.ior = 1.0F;
  glass.attenuation_colour = {0.5F, 0.25F, 1.0F};
  glass.attenuation_distance = 2.0F;
  glass.thickness = 4.0F;
  const auto seen = [&](const scenes::Material& material, const glm::vec3& view) {
    const Shader shader = make_shader(scene);
    return shade(shader, evaluate(shader, material, Point{}, view), view,
                 [](std::size_t, const Incident&) { return 1.0F; });
  };
  const glm::vec3 front = seen(glass, {0, 0, 1}), back = seen(glass, {0, 0, -1});
  const glm::vec3 expected(0.25F, 0.0625F, 1.0F);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(front[k], expected[k], 1e-5);
    EXPECT_NEAR(back[k], 1.0F, 1e-5);
  }
}

TEST(Shade, SpecularScalesWhatDielectricsReflect) {
  Surface surface = floor_surface();
  EXPECT_NEAR(lobes(surface).specular.x, 0.04F, 1e-6F);
  surface.specular = 0.5F;
  surface.specular_colour = {1.0F, 0.0F, 50.0F};
  const Lobes l = lobes(surface);
  EXPECT_NEAR(l.specular.x, 0.02F, 1e-6F);
  EXPECT_EQ(l.specular.y, 0.0F);
  EXPECT_EQ(l.specular.z, 0.5F);
  EXPECT_EQ(l.grazing, 0.5F);
  surface.metallic = 1.0F;
  EXPECT_EQ(lobes(surface).specular, surface.base_colour);
  EXPECT_EQ(lobes(surface).grazing, 1.0F);
}

TEST(Shade, UniformEnvironmentGivesNoMoreThanItHas) {
  scenes::Scene scene;
  scene.environment.zenith = scene.environment.horizon = scene.environment.ground = glm::vec3(1.0F);
  const Shader shader = make_shader(scene);
  for (const float metallic : {0.0F, 0.5F, 1.0F}) {
    for (const float roughness : {0.0F, 0.2F, 0.5F, 1.0F}) {
      for (const float transmission : {0.0F, 1.0F}) {
        for (const float z : {0.05F, 0.5F, 1.0F}) {
          Surface surface = floor_surface();
          surface.base_colour = glm::vec3(1.0F);
          surface.metallic = metallic;
          surface.roughness = roughness;
          surface.transmission = transmission;
          const glm::vec3 colour = shade(shader, surface, {std::sqrt(1.0F - z * z), z, 0},
                                         [](std::size_t, const Incident&) { return 1.0F; });
          EXPECT_LE(colour.x, 1.001F) << metallic << " " << roughness << " " << z;
          EXPECT_GE(colour.x, metallic == 0.5F && transmission > 0 ? 0.4F : 0.98F)
              << metallic << " " << roughness << " " << z;
        }
      }
    }
  }
}

}  // namespace
}  // namespace delray::shading
