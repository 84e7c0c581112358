// The table behind response().
#pragma once

#include <glm/glm.hpp>

#include "shading/brdf.h"

namespace delray::shading {

// What a lobe reflects of light from everywhere, once met, if its reflectance at normal and at
// grazing incidence is 1 and 0 (`normal`), 0 and 1 (`grazing`).
struct SpecularShares {
  float normal, grazing;
};

// Element [i][j]: shares of a lobe of roughness i / (kRoughnesses - 1) to a viewer at a cosine c
// whose root is j / (kCosines - 1). The cosines lie densest at the horizon, where the shares
// change fastest. Row 0 is of a perfect mirror, below kMinRoughness others are as there. Between
// the cosines lie 16 intervals: as many as a vector has lanes.
struct SpecularTable {
  static constexpr int kRoughnesses = 24, kCosines = 17;
  float normal[kRoughnesses][kCosines];
  float grazing[kRoughnesses][kCosines];
  float mean[kRoughnesses];  // of their sum over all viewers, weighted by their cosines
};

// Computed by the first call.
const SpecularTable& specular_table();

// At a roughness from 0 to 1 and the table's j-th cosine, or a cosine from 0 to 1.
SpecularShares specular_shares_at(float roughness, int j);
SpecularShares specular_shares(float roughness, float cosine);

// The table's mean at a roughness.
float mean_albedo(float roughness);

// Lobes::dielectric_again of reflectances at normal and at grazing incidence.
glm::vec3 again(const glm::vec3& normal, float grazing, float mean_albedo);

}  // namespace delray::shading
