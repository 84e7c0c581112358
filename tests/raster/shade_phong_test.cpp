#include "raster/internal/shade_phong.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
    expect_as_pixel_by_pixel<image::RgbaF, PhongTile>(scene, random_scene_camera(), 90, 70,
                                                      Lighting::phong);
  }
}

TEST(ShadePhong, ColoursOfSurfacesAreThoseOfEachAlone) {
  for (unsigned seed = 20; seed < 23; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed);
    for (std::size_t m = 0; m < scene.materials.size(); m += 2) {
      scene.materials[m].alpha = scenes::Material::Alpha::blend;
      scene.materials[m].base_colour.w = 0.3F;
    }
    const Screen screen = make_screen(scenes::make_view(random_scene_camera(), 120, 90));
    const shading::Shader shader = shading::make_shader(scene);
    SceneClusters clusters(scene.meshes);
    const std::vector<std::uint64_t> first = scenes::first_primitives(scene);
    const DrawList list = make_draw_list(pieces_of(scene, first, 0, first.back()), &clusters);
    const FrameShading frame = make_frame_shading(screen, shader, list, Lighting::phong, false);
    // Any triangles at the pixels of their boxes, some of them slivers, in any order.
    std::vector<SurfaceAt> surfaces;
    std::mt19937 random(seed);
    for (int i = 0; i < 9000; ++i) {
      const auto cluster = static_cast<std::uint32_t>(random() % list.clusters.size());
      const Cluster& its = list.clusters[cluster];
      const std::uint32_t place =
          its.begin + static_cast<std::uint32_t>(random()) % (its.end - its.begin);
      surfaces.push_back({cluster << kClusterBits | place, static_cast<int>(random() % 120),
                          static_cast<int>(random() % 90)});
    }
    SeenTriangles seen;
    seen.clear();
    std::vector<image::RgbaF> expected, colours(surfaces.size());
    for (const SurfaceAt& s : surfaces)
      expected.push_back(colour_at(frame, seen, s.number, s.x, s.y));
    const auto tile = std::make_unique<PhongTile>();
    std::size_t through = 0;
    for_each_target([&] {
      tile->colours(frame, seen, surfaces, colours.data());
      for (std::size_t i = 0; i < colours.size(); ++i) {
        // A pixel may lie outside of its triangle here, where there is nothing to agree on.
        const auto finite = [](const image::RgbaF& c) {
          return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
        };
        if (!finite(expected[i])) continue;
        ASSERT_EQ(std::memcmp(&colours[i], &expected[i], sizeof colours[i]), 0) << i;
        through += colours[i].a < 1;
      }
    });
    EXPECT_GT(through, 100U);
  }
}

}  // namespace
}  // namespace delray::raster
