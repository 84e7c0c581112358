// Textures with their chain of smaller copies, and how they are sampled.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "image/image.h"
#include "scenes/scene.h"

namespace delray::shading {

// A texture and its mip levels (Williams 1983). Level 0 has the texture's own texels; each next one
// has half the width and height (rounded down, at least 1) and is the box-filtered average of the
// one before, taken in linear light and weighted by alpha; the last is 1 x 1. Texels are stored as
// in the scene: 8 bits, straight alpha, top row first.
struct Texture {
  struct Level {
    std::size_t first = 0;  // of its texels in `texels`
    int width = 0, height = 0;
  };
  std::vector<image::Rgba8> texels;  // of all levels, one after the other
  std::vector<glm::vec4> radiance;   // in place of texels where the scene has it; w is 1
  std::vector<Level> levels;         // at least one
  bool srgb = true;
  bool opaque = true;  // no texel has an alpha below 255
  scenes::Texture::Wrap wrap_u = scenes::Texture::Wrap::repeat;
  scenes::Texture::Wrap wrap_v = scenes::Texture::Wrap::repeat;
  std::uint8_t set = 0;  // of texture coordinates, as in the scene
};

// A texture without texels becomes one white texel. O(texels). REQUIRES: there is radiance for
// width * height texels, or none.
Texture make_texture(const scenes::Texture& texture);

// How uv changes from one pixel to the next; zero asks for the sharpest level.
struct Footprint {
  glm::vec2 dx{0.0F}, dy{0.0F};
};

// Where a point lies in the textures of a set.
struct TexturePoint {
  glm::vec2 uv{0.0F};
  Footprint footprint;
};

// The level, from 0 to levels - 1, at which a step to the next pixel is about one texel (the longer
// of the two steps decides). Infinite or NaN footprints give the last level.
float mip_level(const Texture& texture, const Footprint& footprint);

// The linear colour with straight alpha at `uv` ((0, 0) is the top left corner of the top left
// texel): bilinear within a level, linear between the two levels beside `level`. Coordinates beyond
// +-2^24 or NaN count as 0. REQUIRES: 0 <= level <= levels - 1.
glm::vec4 sample(const Texture& texture, const glm::vec2& uv, float level);

// The alpha of that alone.
float sample_alpha(const Texture& texture, const glm::vec2& uv, float level);

inline glm::vec4 sample(const Texture& texture, const glm::vec2& uv, const Footprint& footprint) {
  return sample(texture, uv, mip_level(texture, footprint));
}
inline float sample_alpha(const Texture& texture, const glm::vec2& uv, const Footprint& footprint) {
  return sample_alpha(texture, uv, mip_level(texture, footprint));
}

}  // namespace delray::shading
