// What the batch functions look up: a Shader with what is the same at every point computed once.
#pragma once

#include <span>
#include <vector>

#include "shading/brdf.h"
#include "shading/points.h"
#include "shading/shader.h"

namespace delray::shading {

// A material with what its points have in common.
struct BatchMaterial {
  // Where the specular lobe is one and the same, and whether all of its channels are equal.
  enum class Specular : std::uint8_t { grey, coloured, varying };

  scenes::Material material;
  Specular plain = Specular::varying;     // without colours of vertices
  Specular coloured = Specular::varying;  // with them
  bool covers = false;                    // alpha is 1 everywhere, without colours of vertices
  int texture_sets = 0;                   // it looks at the uvs of so many
  Lobes lobes;                            // of the material's factors alone

  bool layered = false;         // has a coat or a sheen
  bool absorbs = false;         // light on its way through bodies of it
  glm::vec3 attenuation{1.0F};  // Surface::attenuation of front sides

  // specular_shares of its roughness at the first 16 cosines of their table, and their growth from
  // each to the next.
  alignas(64) float normal[kBlockPoints], normal_step[kBlockPoints];
  alignas(64) float grazing[kBlockPoints], grazing_step[kBlockPoints];
};

// A light as blocks of points look at it.
struct BatchLight {
  scenes::Light::Kind kind = scenes::Light::Kind::directional;
  bool dark = false;  // nothing comes from it anywhere
  glm::vec3 colour{0.0F};
  glm::vec3 direction{0, 0, 1};  // directional: to the light
  glm::vec3 source{0.0F};        // point and area: where it is
  glm::vec3 normal{0.0F};        // area: its length is the area
  float area_over_pi = 0.0F;
};

// Refers to the shader that it was made from.
struct BatchShader {
  const Shader* shader = nullptr;
  std::vector<BatchMaterial> materials;
  std::vector<BatchLight> lights;

  const BatchMaterial& material(std::uint32_t number) const {
    return materials[number < materials.size() ? number : 0];
  }
};

// With the shader's materials, or with others in their place (the same without textures, say).
// REQUIRES: there is at least one; their textures are the shader's or kNone. O(materials + lights).
BatchShader make_batch_shader(const Shader& shader, std::span<const scenes::Material> materials);
inline BatchShader make_batch_shader(const Shader& shader) {
  return make_batch_shader(shader, shader.materials);
}

}  // namespace delray::shading
