// What lies on top of a surface: a sheen of fibres that stand up, and over it a clear coat (glTF's
// KHR_materials_sheen and KHR_materials_clearcoat). The coat is a second specular lobe of a
// dielectric of index 1.5; the sheen is Estevez and Kulla's distribution (2017) with Neubelt and
// Pettineo's shadowing (2013). Each layer leaves to what is below what it does not reflect towards
// the viewer, so that white surfaces neither lose nor gain light.
#pragma once

#include <glm/glm.hpp>

#include "shading/brdf.h"
#include "shading/surface.h"

namespace delray::shading {

// Of one surface, seen by one viewer.
struct Layers {
  float coat = 0.0F;           // scale of the coat's lobe
  float coat_alpha = 0.0064F;  // GGX width
  float coat_roughness = 0.0F;
  float coat_albedo = 0.0F;  // fraction of light from everywhere that the coat reflects
  glm::vec3 coat_normal{0, 0, 1};
  glm::vec3 sheen{0.0F};         // scale of the sheen's lobe
  float sheen_exponent = 1.0F;   // of the sine between normal and half vector
  glm::vec3 sheen_albedo{0.0F};  // fraction of light from everywhere that the sheen reflects
  float below_coat = 1.0F;       // what is left to what lies below the coat
  float below = 1.0F;            // and below both
};

// `view` is the unit vector to the viewer.
Layers layers(const Surface& surface, const glm::vec3& view);

// What the layers add to reflect() of what lies below them. `normal` is the surface's.
glm::vec3 reflect(const Layers& layers, const glm::vec3& normal, const glm::vec3& view,
                  const glm::vec3& light);

// The sheen's part of it.
glm::vec3 reflect_by_sheen(const Layers& layers, const glm::vec3& normal, const glm::vec3& view,
                           const glm::vec3& light);

// The coat's part of it, and what Schlick says that the coat reflects of light that meets it at
// this cosine.
float reflect_by_coat(const Layers& layers, const glm::vec3& view, const glm::vec3& light);
float coat_fresnel(float cosine);

// The response below the layers.
inline void darken(const Layers& layers, Response& response) {
  response.specular *= layers.below;
  response.scale *= layers.below;
  response.entering *= layers.below;
}

}  // namespace delray::shading
