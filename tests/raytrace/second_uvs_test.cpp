// Textures that are looked up at a mesh's second set of coordinates.
#include <gtest/gtest.h>

#include <cstring>

#include "comm/threads.h"
#include "parallel/arena.h"
#include "raytrace/distribution.h"
#include "raytrace/render.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

std::uint32_t add_texture(scenes::Scene& scene, std::uint32_t seed) {
  scenes::Texture texture;
  texture.width = texture.height = 8;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const std::uint32_t bits = (i + 64 * seed) * 0x9E3779B9U;
    texture.texels.push_back(
        {static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits >> 16),
         static_cast<std::uint8_t>(bits >> 24), static_cast<std::uint8_t>(bits % 2 * 255)});
  }
  scene.textures.push_back(texture);
  return static_cast<std::uint32_t>(scene.textures.size()) - 1;
}

// Surfaces with holes, that glow, with a normal map, a coat, glass; one texture each.
scenes::Scene textured_scene() {
  scenes::Scene scene;
  const auto add_textured = [&](scenes::Mesh mesh, const glm::mat4x3& at) -> scenes::Material& {
    for (const glm::vec3& p : mesh.positions) mesh.uvs.emplace_back(1.7F * p.x + p.z, 1.3F * p.y);
    return add(scene, mesh, at);
  };
  add_textured(quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}), placed(1, {})).base_colour_texture =
      add_texture(scene, 1);
  scenes::Material& masked =
      add_textured(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), placed(1, {0.4F, 0, 0.5F}));
  masked.alpha = scenes::Material::Alpha::mask;
  masked.base_colour_texture = add_texture(scene, 2);
  scenes::Material& emissive = add_textured(quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}), placed(1, {}));
  emissive.emission = {4, 3, 2};
  emissive.emission_texture = add_texture(scene, 3);
  emissive.alpha = scenes::Material::Alpha::blend;
  emissive.base_colour_texture = add_texture(scene, 4);
  scenes::Material& mapped = add_textured(sphere(10), placed(0.6F, {-1, 0, 0}));
  mapped.normal_texture = add_texture(scene, 5);
  mapped.metallic_roughness_texture = add_texture(scene, 6);
  mapped.clearcoat = 0.8F;
  mapped.clearcoat_texture = add_texture(scene, 7);
  scenes::Material& glass = add_textured(quad({-1, -1, 1}, {1, 0, 0}, {0, 2, 0}), placed(1, {}));
  glass.transmission = 0.9F;
  glass.thickness = 0;
  glass.transmission_texture = add_texture(scene, 8);
  scene.lights.emplace_back().direction = glm::normalize(glm::vec3(-0.3F, -1, -0.6F));
  scene.environment.zenith = scene.environment.horizon = {0.2F, 0.3F, 0.4F};
  scene.cameras.emplace_back().eye = {0, 0.5F, 5};
  return scene;
}

// Every other texture from number `first_moved` on is of set 1 now; what nothing looks at has other
// coordinates.
scenes::Scene with_second_uvs(scenes::Scene scene, std::size_t first_moved) {
  for (std::size_t i = first_moved; i < scene.textures.size(); i += 2) scene.textures[i].set = 1;
  const std::vector<scenes::Material>& materials = scene.materials;
  for (scenes::Mesh& mesh : scene.meshes) {
    mesh.uvs2 = mesh.uvs;
    bool first = false, second = false;
    for (const std::uint32_t texture : materials[mesh.material].textures()) {
      if (texture == scenes::kNone) continue;
      (scene.textures[texture].set == 0 ? first : second) = true;
    }
    for (glm::vec2& uv : mesh.uvs) uv = first ? uv : glm::vec2(3 * uv.y, 0.2F);
    for (glm::vec2& uv : mesh.uvs2) uv = second ? uv : glm::vec2(0.7F, uv.x);
  }
  return scene;
}

void expect_same_colours(const Result& a, const Result& b) {
  ASSERT_EQ(a.image.pixels(), b.image.pixels());
  EXPECT_EQ(std::memcmp(a.image.colour.data(), b.image.colour.data(),
                        a.image.pixels() * sizeof(image::RgbaF)),
            0);
}

class SecondUvs : public testing::TestWithParam<const char*> {};

TEST_P(SecondUvs, LookAsTheFirst) {
  const parallel::AllowThreads allowed(4);
  scenes::Scene scene = textured_scene();
  scenes::Scene moved = with_second_uvs(scene, 1), others = with_second_uvs(scene, 0);
  for (scenes::Scene* one : {&scene, &moved, &others}) scenes::complete(*one, one->cameras[0]);
  ASSERT_FALSE(moved.meshes[3].tangents.empty());
  RenderOptions options = small(48, 40);
  options.samples = 4;
  options.integrator = GetParam();
  const Result expected = render_alone(scene, scene.cameras[0], options);
  expect_same_colours(render_alone(moved, moved.cameras[0], options), expected);
  expect_same_colours(render_alone(others, others.cameras[0], options), expected);
  for (const Distribution& distribution : distributions()) {
    SCOPED_TRACE(distribution.name);
    if (distribution.replicated) continue;
    Result result;
    comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
      ShareOptions share;
      share.most_triangles = 16;
      SharedScene mine = SharedScene::make(communicator, moved, share_options(distribution, share));
      Renderer renderer(mine, distribution);
      Result one = renderer.render(communicator, moved.cameras[0], options);
      if (communicator.rank() == 0) result = std::move(one);
    });
    expect_same_colours(result, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, SecondUvs, testing::Values("path", "direct", "whitted"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace delray::raytrace
