// A small scene in which much goes on.
#pragma once

#include <random>

#include "scenes/scene.h"

namespace delray::raster {

// Instances of a few meshes: textured, coloured, with holes, mirrored, through each other and
// through the near plane, and some at the very same place so that depths tie.
inline scenes::Scene random_scene(unsigned seed, int triangles_per_mesh = 40) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  scenes::Scene scene;
  scene.materials.resize(4);
  scene.materials[1].base_colour_texture = 0;
  scene.materials[1].metallic = 0.7F;
  scene.materials[2].base_colour_texture = 0;
  scene.materials[2].alpha = scenes::Material::Alpha::mask;
  scene.materials[3].double_sided = false;
  scene.materials[3].normal_texture = 1;
  scene.textures.resize(2);
  for (scenes::Texture& texture : scene.textures) {
    texture.width = 8;
    texture.height = 6;
    for (int i = 0; i < 48; ++i) {
      texture.texels.push_back(
          {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
           static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random() % 2 * 255)});
    }
  }
  scene.textures[1].srgb = false;
  for (std::uint32_t m = 0; m < 4; ++m) {
    scenes::Mesh mesh;
    mesh.material = m;
    for (int i = 0; i < triangles_per_mesh; ++i) {
      const glm::vec3 centre(both(random), both(random), both(random));
      const float size = i % 8 == 0 ? 1.0F : 0.15F;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (int k = 0; k < 3; ++k) {
        mesh.positions.push_back(centre +
                                 size * glm::vec3(both(random), both(random), both(random)));
        mesh.normals.push_back(glm::normalize(glm::vec3(both(random), both(random), 1)));
        mesh.uvs.emplace_back(3 * both(random), 3 * both(random));
        if (m == 0) mesh.colours.emplace_back(unit(random), unit(random), unit(random), 1);
        if (m == 3) mesh.tangents.emplace_back(1, 0, 0, k == 0 ? 1 : -1);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
      if (i % 5 == 0) mesh.triangles.emplace_back(first, first + 2, first + 1);
    }
    scene.meshes.push_back(mesh);
  }
  const glm::mat4x3 identity(1.0F);
  glm::mat4x3 mirrored(1.0F), through(2.0F);
  mirrored[0].x = -1;
  through[3] = {0, 0, 2};
  scene.instances = {{0, identity}, {1, identity}, {2, identity}, {3, identity},
                     {0, identity}, {3, mirrored}, {1, through},  {2, identity}};
  scene.lights.push_back({});
  scene.lights.push_back({scenes::Light::Kind::point, glm::vec3(5.0F), {2, 2, 2}});
  scene.environment.zenith = {0.3F, 0.4F, 0.6F};
  scene.environment.horizon = {0.4F, 0.4F, 0.4F};
  return scene;
}

// The same with glass of its own colour, of a texture's and of the vertices' alpha.
inline scenes::Scene transparent_scene(unsigned seed, int triangles_per_mesh = 40) {
  scenes::Scene scene = random_scene(seed, triangles_per_mesh);
  for (const std::size_t i : {0U, 1U}) scene.materials[i].alpha = scenes::Material::Alpha::blend;
  scene.materials[0].base_colour.w = 0.4F;
  for (glm::vec4& colour : scene.meshes[0].colours) colour.w = colour.x < 0.1F ? 0.0F : colour.y;
  return scene;
}

// A scene of the same picture in which the first texture is of set 1, with other coordinates in set
// 0 where nothing looks at them.
inline scenes::Scene with_second_uvs(scenes::Scene scene) {
  scene.textures[0].set = 1;
  for (scenes::Mesh& mesh : scene.meshes) {
    mesh.uvs2 = mesh.uvs;
    if (scene.materials[mesh.material].normal_texture != scenes::kNone) continue;
    for (glm::vec2& uv : mesh.uvs) uv = {0.3F - 2 * uv.y, uv.x};
  }
  return scene;
}

inline scenes::Camera random_scene_camera() {
  scenes::Camera camera;
  camera.eye = {0.5F, 0.7F, 3};
  camera.vertical_fov = 45;
  camera.near = 0.05F;
  return camera;
}

}  // namespace delray::raster
