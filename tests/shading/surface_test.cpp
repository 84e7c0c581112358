#include "shading/surface.h"

#include <gtest/gtest.h>

namespace delray::shading {
namespace {

Shader shader_with(image::Rgba8 texel, bool srgb = false) {
  scenes::Scene scene;
  scene.materials.emplace_back();
  scenes::Texture texture;
  texture.width = texture.height = 1;
  texture.srgb = srgb;
  texture.texels = {texel};
  scene.textures.push_back(texture);
  return make_shader(scene);
}

TEST(Surface, NormalsTurnToTheViewer) {
  const Shader shader = shader_with({255, 255, 255, 255});
  Point point;
  point.normal = glm::normalize(glm::vec3(0.5F, 0, 1));
  const Surface front = evaluate(shader, shader.materials[0], point, {0, 0, 1});
  EXPECT_TRUE(front.front);
  EXPECT_EQ(front.normal, point.normal);
  const Surface back = evaluate(shader, shader.materials[0], point, {0, 0, -1});
  EXPECT_FALSE(back.front);
  EXPECT_EQ(back.normal, -point.normal);
  EXPECT_EQ(back.geometric_normal, glm::vec3(0, 0, -1));
  point.normal = -point.normal;
  EXPECT_EQ(evaluate(shader, shader.materials[0], point, {0, 0, 1}).normal, -point.normal);
}

TEST(Surface, TexturesMultiplyFactors) {
  const Shader shader = shader_with({51, 102, 204, 255});
  scenes::Material material;
  material.base_colour = {0.5F, 0.5F, 0.5F, 1.0F};
  material.roughness = 0.5F;
  material.metallic = 1.0F;
  material.emission = glm::vec3(2.0F);
  material.base_colour_texture = material.metallic_roughness_texture = material.emission_texture =
      0;
  Point point;
  point.colour = {1, 1, 0.5F, 1};
  const Surface surface = evaluate(shader, material, point, {0, 0, 1});
  EXPECT_NEAR(surface.base_colour.x, 0.1F, 1e-6);
  EXPECT_NEAR(surface.base_colour.z, 0.2F, 1e-6);
  EXPECT_NEAR(surface.roughness, 0.2F, 1e-6);
  EXPECT_NEAR(surface.metallic, 0.8F, 1e-6);
  EXPECT_NEAR(surface.emission.y, 0.8F, 1e-6);
}

TEST(Surface, NormalMapsTiltAlongTheTangent) {
  scenes::Material material;
  material.normal_texture = 0;
  Point point;
  point.tangent = {1, 0, 0, 1};
  const Shader flat = shader_with({128, 128, 255, 255});
  const Surface untouched = evaluate(flat, material, point, {0, 0, 1});
  EXPECT_NEAR(untouched.normal.z, 1.0F, 1e-4);
  const Shader tilted = shader_with({255, 128, 128, 255});
  EXPECT_NEAR(evaluate(tilted, material, point, {0, 0, 1}).normal.x, 1.0F, 1e-4);
  const Shader up = shader_with({128, 255, 128, 255});
  EXPECT_NEAR(evaluate(up, material, point, {0, 0, 1}).normal.y, 1.0F, 1e-4);
  point.tangent.w = -1;
  EXPECT_NEAR(evaluate(up, material, point, {0, 0, 1}).normal.y, -1.0F, 1e-4);
  point.tangent.w = 0;
  EXPECT_EQ(evaluate(tilted, material, point, {0, 0, 1}).normal, glm::vec3(0, 0, 1));
}

TEST(Surface, AlphaFollowsItsMode) {
  const Shader shader = shader_with({255, 255, 255, 102});
  scenes::Material material;
  material.base_colour_texture = 0;
  using Alpha = scenes::Material::Alpha;
  const auto alpha = [&](Alpha mode, float cutoff) {
    material.alpha = mode;
    material.alpha_cutoff = cutoff;
    const float whole = evaluate(shader, material, {}, {0, 0, 1}).alpha;
    EXPECT_EQ(coverage(shader, material, {}, {}, 1.0F), whole);
    return whole;
  };
  EXPECT_EQ(alpha(Alpha::opaque, 0.5F), 1.0F);
  EXPECT_EQ(alpha(Alpha::mask, 0.5F), 0.0F);
  EXPECT_EQ(alpha(Alpha::mask, 0.3F), 1.0F);
  EXPECT_NEAR(alpha(Alpha::blend, 0.5F), 0.4F, 1e-6);
}

TEST(Surface, UnknownTexturesAndMaterialsAreReplaced) {
  scenes::Scene scene;
  EXPECT_EQ(make_shader(scene).materials.size(), 1U);
  scene.materials.emplace_back();
  scene.materials[0].base_colour_texture = 12;
  const Shader shader = make_shader(scene);
  EXPECT_EQ(shader.materials[0].base_colour_texture, scenes::kNone);
  EXPECT_EQ(&material(shader, 99), &shader.materials[0]);
}

}  // namespace
}  // namespace delray::shading
