// Light that arrives from everywhere.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "scenes/scene.h"
#include "shading/texture.h"

namespace delray::shading {

// scenes::Environment with what is computed once.
//
// A gradient's radiance is linear in the height of the direction (its cosine with `up`). In a
// latitude-longitude texture the middle column looks along `front`, columns to the right of it
// towards `right`, the top row along `up`; front is -z and right is +x when up is +y.
struct Environment {
  std::uint32_t texture = scenes::kNone;
  glm::vec3 up{0, 1, 0}, front{0, 0, -1}, right{1, 0, 0};
  glm::vec3 zenith{0.0F}, horizon{0.0F}, ground{0.0F};
  std::array<glm::vec3, 9> harmonics{};  // of the texture, convolved with the cosine, over pi
  bool black = true;                     // nothing comes from anywhere
};

// A texture number out of range gives the gradient; an `up` of length 0 becomes +y.
Environment make_environment(const scenes::Environment& environment,
                             std::span<const Texture> textures);

// Radiance from `direction` (unit length), averaged over a cone that grows with `roughness`, 0 to 1
// (an approximation: a blurred level of the texture, or a mixture with the diffuse average).
glm::vec3 radiance(const Environment& environment, std::span<const Texture> textures,
                   const glm::vec3& direction, float roughness = 0.0F);

// The mean of the radiance weighted with the cosine to `normal` (unit length): irradiance over pi,
// which is what a white Lambertian surface reflects. Exact for a gradient; nine spherical harmonics
// of a texture (Ramamoorthi and Hanrahan 2001), never negative.
glm::vec3 diffuse_radiance(const Environment& environment, const glm::vec3& normal);

}  // namespace delray::shading
