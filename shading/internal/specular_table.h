// The table behind specular_albedo.
#pragma once

#include <glm/glm.hpp>

#include "shading/brdf.h"

namespace delray::shading {

// Element [i][j]: what a lobe of roughness i / (kRoughnesses - 1) reflects of light from everywhere
// to a viewer at a cosine c with c (2 - c) = j / (kCosines - 1), if its reflectance at normal and
// at grazing incidence is 1 and 0 (`normal`), 0 and 1 (`grazing`). The cosines lie densest at the
// horizon, where the shares change fastest; between them lie 16 intervals: as many as a vector has
// lanes.
struct SpecularTable {
  static constexpr int kRoughnesses = 24, kCosines = 17;
  float normal[kRoughnesses][kCosines];
  float grazing[kRoughnesses][kCosines];
};

// Computed by the first call.
const SpecularTable& specular_table();

// specular_albedo at the table's j-th cosine.
glm::vec3 specular_albedo_at(const Lobes& lobes, int j);

}  // namespace delray::shading
