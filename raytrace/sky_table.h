// Directions to the environment, drawn where it is bright.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raytrace/alias_table.h"
#include "shading/environment.h"

namespace delray::raytrace {

// A direction and the density with which it is drawn, per steradian.
struct SkyDirection {
  glm::vec3 direction{0, 0, 1};
  float pdf = 0.0F;
};

// The sphere cut into rows of equal angle and columns; a cell is drawn by its light, a direction
// within it uniformly. Every direction has a positive density.
class SkyTable {
 public:
  SkyTable() = default;
  // O(cells): at most 256 x 128.
  SkyTable(const shading::Environment& environment, std::span<const shading::Texture> textures);

  // Numbers from [0, 1): two to choose the cell, two for the place in it.
  SkyDirection sample(const glm::vec2& cell, const glm::vec2& place) const;
  float pdf(const glm::vec3& direction) const;  // of a unit vector

  // The integral of the radiance over all directions, mean of the channels.
  float integral() const { return integral_; }

 private:
  float cell_pdf(int row, std::uint32_t cell) const;

  glm::vec3 up_{0, 1, 0}, front_{0, 0, -1}, right_{1, 0, 0};
  int rows_ = 0, columns_ = 0;
  std::vector<float> heights_;  // cosines between rows, from 1 down to -1
  AliasTable table_;
  float integral_ = 0.0F;
};

}  // namespace delray::raytrace
