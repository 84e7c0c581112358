#include "raster/internal/shade_phong.h"

#include <gtest/gtest.h>

#include "scenes/generate.h"
#include "scenes/load.h"
#include "tests/raster/random_scene.h"
#include "tests/raster/shade_both_ways.h"

namespace delray::raster {
namespace {

template <class Colour>
void expect_as_pixel_by_pixel(const scenes::Scene& scene, const scenes::Camera& camera, int width,
                              int height) {
  raster::expect_as_pixel_by_pixel<Colour, PhongTile>(scene, camera, width, height,
                                                      Lighting::phong);
}

TEST(ShadePhong, GivesWhatPixelByPixelGives) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = random_scene(seed);
    expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 131, 97);
    expect_as_pixel_by_pixel<image::RgbaF>(scene, random_scene_camera(), 66, 130);
  }
  for (const char* name : {"gen:terrain:40000", "gen:city:3000", "gen:field:20000"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::generate(name);
    expect_as_pixel_by_pixel<image::Rgba8>(scene, scene.cameras[0], 150, 100);
  }
}

TEST(ShadePhong, UsesNormalsOfTrianglesWhereVerticesHaveNone) {
  scenes::Scene scene = random_scene(4);
  for (scenes::Mesh& mesh : scene.meshes) mesh.normals.clear();
  expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 80, 70);
  scene = random_scene(5);
  for (scenes::Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.normals.size(); i += 2) mesh.normals[i] = glm::vec3(0.0F);
  expect_as_pixel_by_pixel<image::Rgba8>(scene, random_scene_camera(), 80, 70);
}

// Textures, normal maps and colours of vertices on some meshes and not on others.
TEST(ShadePhong, MixesKindsOfMaterials) {
  for (unsigned seed = 10; seed < 14; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed);
    scenes::Texture texture;
    texture.width = texture.height = 4;
    for (std::size_t i = 0; i < 16; ++i)
      texture.texels.push_back(
          {static_cast<std::uint8_t>(16 * i), static_cast<std::uint8_t>(255 - 9 * i), 128, 255});
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
    expect_as_pixel_by_pixel<image::RgbaF>(scene, random_scene_camera(), 90, 70);
  }
}

}  // namespace
}  // namespace delray::raster
