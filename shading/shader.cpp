#include "shading/shader.h"

namespace delray::shading {

Shader make_shader(const scenes::Scene& scene) {
  Shader shader;
  shader.materials = scene.materials;
  if (shader.materials.empty()) shader.materials.emplace_back();
  shader.textures.reserve(scene.textures.size());
  for (const scenes::Texture& texture : scene.textures) {
    shader.textures.push_back(make_texture(texture));
  }
  const auto check = [&](std::uint32_t& texture) {
    if (texture >= shader.textures.size()) texture = scenes::kNone;
  };
  for (scenes::Material& m : shader.materials) {
    check(m.base_colour_texture);
    check(m.metallic_roughness_texture);
    check(m.normal_texture);
    check(m.emission_texture);
  }
  shader.lights = scene.lights;
  shader.environment = make_environment(scene.environment, shader.textures);
  return shader;
}

}  // namespace delray::shading
