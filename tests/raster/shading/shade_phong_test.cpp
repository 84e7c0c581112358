#include "raster/shading/shade_phong.h"

#include <gtest/gtest.h>

#include "tests/raster/shade_both_ways.h"

namespace delray::raster {
namespace {

TEST(ShadePhong, GivesWhatPixelByPixelGives) {
  expect_vectors_give_what_pixels_give<PhongTile>(Lighting::phong);
}

// Textures, normal maps and colours of vertices on some meshes and not on others.
TEST(ShadePhong, MixesKindsOfMaterials) {
  for (unsigned seed = 10; seed < 14; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed);
    scenes::Texture texture;
    texture.width = texture.height = 4;
    for (std::size_t i = 0; i < 16; ++i) {
      texture.texels.push_back(
          {static_cast<std::uint8_t>(16 * i), static_cast<std::uint8_t>(255 - 9 * i), 128, 255});
    }
    scene.textures.push_back(texture);
    const auto number = static_cast<std::uint32_t>(scene.textures.size() - 1);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
      if (m % 2 == 0) scene.materials[m].base_colour_texture = number;
      if (m % 3 == 0) scene.materials[m].normal_texture = number;
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      scenes::Mesh& mesh = scene.meshes[m];
      const std::size_t vertices = mesh.positions.size();
      mesh.colours.clear();
      mesh.uvs.clear();
      mesh.tangents.clear();
      for (std::size_t v = 0; v < vertices; ++v) {
        const auto x = static_cast<float>(v);
        if ((m + seed) % 2 == 0) mesh.colours.emplace_back(0.5F, x / 9, 0.2F, 1.0F);
        if ((m + seed) % 3 != 0) mesh.uvs.emplace_back(x * 0.3F, x * x * 0.1F);
        if ((m + seed) % 5 != 0) mesh.tangents.emplace_back(1, x, 0.5F, v % 2 == 0 ? 1 : -1);
      }
    }
    expect_as_pixel_by_pixel<image::RgbaF, PhongTile>(scene, random_scene_camera(), 90, 70,
                                                      Lighting::phong);
  }
}

TEST(ShadePhong, ColoursOfSurfacesAreThoseOfEachAlone) {
  expect_colours_of_each_alone<PhongTile>(Lighting::phong);
}

}  // namespace
}  // namespace delray::raster
