// Directions to the environment, drawn where it is bright.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raytrace/sampling/alias_table.h"
#include "raytrace/sampling/sampler.h"
#include "shading/environment.h"
#include "shading/points.h"

namespace delray::raytrace {

struct SkyCells {
  glm::vec3 up{0, 1, 0}, front{0, 0, -1}, right{1, 0, 0};
  int rows = 0, columns = 0;
  std::vector<float> heights;  // cosines between rows, from 1 down to -1
  AliasTable table;            // of cells, row by row
};

// The sphere cut into rows of equal angle and columns; a cell is drawn by its light, a direction
// within it uniformly. Every direction has a positive density.
class SkyTable {
 public:
  SkyTable() = default;
  // O(cells): at most 1024 columns of a texture. REQUIRES: no more than 2^21 cells.
  SkyTable(const shading::Environment& environment, std::span<const shading::Texture> textures);

  // Sixteen lanes by vectors, all of them written. Numbers from [0, 1): two to choose the cell, two
  // for the place in it. Densities are per steradian.
  void sample(const Pairs16& cell, const Pairs16& place, shading::Vectors16& directions,
              shading::Floats16& pdfs) const;
  void pdf(const shading::Vectors16& directions, shading::Floats16& pdfs) const;  // unit vectors

  // The integral of the radiance over all directions, mean of the channels.
  float integral() const { return integral_; }

 private:
  SkyCells cells_;
  float integral_ = 0.0F;
};

}  // namespace delray::raytrace
