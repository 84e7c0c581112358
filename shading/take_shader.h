// Shaders without copies of textures.
#pragma once

#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::shading {

// As make_shader, but the texels of the scene become those of the shader: its textures keep their
// names and sizes only. For scenes that nobody else shades. O(texels).
Shader take_shader(scenes::Scene& scene);

// As make_texture of what `texture` was; its texels are moved. No memory but for the smaller levels
// where the texels have room for those (a third more) behind them.
Texture take_texture(scenes::Texture& texture);

}  // namespace delray::shading
