// Copies what shading needs out of a scene, or moves its texels (take_shader). Numbers of textures
// that do not exist become kNone, and unlit materials lose all but their colour, so that shading
// need not check either.
#include "shading/shader.h"

#include <algorithm>

#include "shading/take_shader.h"

namespace delray::shading {

namespace {

// Of what shows its colour whatever the light nothing else counts.
void leave_colour_only(scenes::Material& m) {
  m.metallic = m.transmission = m.clearcoat = 0.0F;
  m.sheen_colour = m.emission = glm::vec3(0.0F);
  const std::uint32_t colour = m.base_colour_texture;
  for (std::uint32_t* const texture : m.textures()) *texture = scenes::kNone;
  m.base_colour_texture = colour;
}

// `texture_of` makes the scene's texture of a number.
template <class TextureOf>
Shader shader_of(const scenes::Scene& scene, TextureOf&& texture_of) {
  Shader shader;
  shader.materials = scene.materials;
  if (shader.materials.empty()) shader.materials.emplace_back();
  shader.textures.reserve(scene.textures.size());
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    shader.textures.push_back(texture_of(i));
  }
  // Radiance is of environments only.
  const auto check = [&](std::uint32_t& texture) {
    if (texture >= shader.textures.size() || !shader.textures[texture].radiance.empty())
      texture = scenes::kNone;
  };
  for (scenes::Material& m : shader.materials) {
    for (std::uint32_t* const texture : m.textures()) check(*texture);
    if (m.unlit) leave_colour_only(m);
  }
  shader.lights = scene.lights;
  shader.environment = make_environment(scene.environment, shader.textures);
  return shader;
}

}  // namespace

Shader make_shader(const scenes::Scene& scene) {
  return shader_of(scene, [&](std::size_t i) { return make_texture(scene.textures[i]); });
}

int texture_sets(const Shader& shader, const scenes::Material& material) {
  int sets = 0;
  for (const std::uint32_t texture : material.textures()) {
    if (texture != scenes::kNone) sets = std::max(sets, shader.textures[texture].set + 1);
  }
  return sets;
}

Shader take_shader(scenes::Scene& scene) {
  return shader_of(scene, [&](std::size_t i) { return take_texture(scene.textures[i]); });
}

}  // namespace delray::shading
