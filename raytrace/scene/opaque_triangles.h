// Triangles of materials that can be seen through which nobody sees through: shadow rays end there
// without a look at the texture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "shading/shader.h"

namespace delray::raytrace {

// The least alpha in square tiles of a texture's first level.
class LeastAlpha {
 public:
  LeastAlpha() = default;  // knows nothing
  explicit LeastAlpha(const shading::Texture& texture);

  // Over all texels that bilinear filtering may touch within a box of coordinates, 0 to 255; of
  // boxes that are too large, over all of the texture.
  int over(const glm::vec2& low, const glm::vec2& high) const;

  int set() const { return set_; }  // of texture coordinates

 private:
  int columns_ = 0, width_ = 0, height_ = 0, set_ = 0;
  scenes::Texture::Wrap wrap_u_{}, wrap_v_{};
  std::uint8_t everywhere_ = 0;
  std::vector<std::uint8_t> least_;
};

// Element i is of texture i, if a material's alpha is looked up there. O(texels), parallel.
std::vector<LeastAlpha> least_alphas(const shading::Shader& shader);

// One bit for each triangle, bit i % 64 of word i / 64; 1: shading::coverage is 1 wherever a shadow
// ray may meet it. A triangle that spans a large part of a texture, or whose vertices have colours,
// counts as 0 without a look. Empty if no bit is 1, as with materials that transmit light.
// O(triangles).
std::vector<std::uint64_t> opaque_triangles(const scenes::Mesh& mesh,
                                            const scenes::Material& material,
                                            std::span<const LeastAlpha> alphas);

}  // namespace delray::raytrace
