// A scene flattened for shading: what both renderers look up at every pixel.
#pragma once

#include <span>
#include <vector>

#include "scenes/scene.h"
#include "shading/environment.h"
#include "shading/texture.h"

namespace delray::shading {

// Numbers of materials and textures are those of the scene. Does not refer to the scene.
struct Shader {
  std::vector<scenes::Material> materials;  // at least one
  std::vector<Texture> textures;
  std::vector<scenes::Light> lights;  // area lights with edge_u x edge_v = 0 stay, and give nothing
  Environment environment;
};

// A texture number out of range becomes kNone; a scene without materials gets the default one.
// O(texels).
Shader make_shader(const scenes::Scene& scene);

// The material of a number, the first one if it is out of range.
inline const scenes::Material& material(const Shader& shader, std::uint32_t number) {
  return shader.materials[number < shader.materials.size() ? number : 0];
}

// The sets of texture coordinates that a material's textures use: 0: none, 1: the first, 2: both.
// REQUIRES: its textures are the shader's or kNone.
int texture_sets(const Shader& shader, const scenes::Material& material);

}  // namespace delray::shading
