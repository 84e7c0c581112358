#include "raytrace/scene/opaque_triangles.h"

#include <gtest/gtest.h>

#include <random>

#include "shading/surface.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

using Wrap = scenes::Texture::Wrap;

// Opaque but for some texels.
scenes::Texture with_holes(int width, int height, Wrap wrap, std::mt19937& random) {
  scenes::Texture texture;
  texture.width = width;
  texture.height = height;
  texture.wrap_u = texture.wrap_v = wrap;
  texture.texels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                        {255, 255, 255, 255});
  for (int i = 0; i < 12; ++i) {
    texture.texels[random() % texture.texels.size()].a = static_cast<std::uint8_t>(random() % 255);
  }
  return texture;
}

TEST(SolidTriangles, AreCoveredEverywhere) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  int opaque = 0, others = 0;
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp}) {
    for (const auto alpha : {scenes::Material::Alpha::blend, scenes::Material::Alpha::mask}) {
      scenes::Scene scene;
      scenes::Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
      mesh.positions.clear();
      mesh.triangles.clear();
      for (std::uint32_t i = 0; i < 300; ++i) {
        const glm::vec2 at(unit(random) * 6 - 3, unit(random) * 6 - 3);
        for (std::uint32_t k = 0; k < 3; ++k) {
          mesh.positions.emplace_back(unit(random), unit(random), unit(random));
          mesh.uvs.push_back(at + 0.15F * glm::vec2(unit(random), unit(random)));
        }
        mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
      }
      scenes::Material& material = add(scene, mesh);
      scene.textures.push_back(with_holes(61, 35, wrap, random));
      material.base_colour_texture = 0;
      material.alpha = alpha;
      material.alpha_cutoff = 0.9F;
      const shading::Shader shader = shading::make_shader(scene);
      const auto bits = opaque_triangles(mesh, scene.materials.back(), least_alphas(shader));
      ASSERT_EQ(bits.size(), 5U);
      for (std::uint32_t i = 0; i < 300; ++i) {
        if ((bits[i / 64] >> (i % 64) & 1) == 0) {
          ++others;
          continue;
        }
        ++opaque;
        for (int point = 0; point < 100; ++point) {
          float u = unit(random), v = unit(random);
          if (u + v > 1.0F) u = 1.0F - u, v = 1.0F - v;
          const glm::vec2 uv =
              mesh.uvs[3 * i] * (1.0F - u - v) + mesh.uvs[3 * i + 1] * u + mesh.uvs[3 * i + 2] * v;
          ASSERT_EQ(shading::coverage(shader, scene.materials.back(), uv, {}, 1.0F), 1.0F)
              << "seed 11, triangle " << i;
        }
      }
    }
  }
  EXPECT_GT(opaque, 300);
  EXPECT_GT(others, 300);
}

TEST(SolidTriangles, ThereAreNoneWhereAllIsSeenThrough) {
  const scenes::Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  scenes::Material material;
  material.alpha = scenes::Material::Alpha::blend;
  EXPECT_EQ(opaque_triangles(mesh, material, {}), std::vector<std::uint64_t>{3});
  material.base_colour.w = 0.5F;
  EXPECT_TRUE(opaque_triangles(mesh, material, {}).empty());
  material.base_colour.w = 1.0F;
  material.transmission = 0.1F;
  EXPECT_TRUE(opaque_triangles(mesh, material, {}).empty());
  material.transmission = 0.0F;
  scenes::Mesh coloured = mesh;
  coloured.colours.assign(4, {1, 1, 1, 0.5F});
  EXPECT_TRUE(opaque_triangles(coloured, material, {}).empty());
}

}  // namespace
}  // namespace delray::raytrace
