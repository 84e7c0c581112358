// The light that leaves a point towards the viewer, as far as the point itself and the lights
// decide it: both renderers' local lighting. Linear RGB radiance; sums are taken in a fixed order.
#pragma once

#include <glm/glm.hpp>

#include "shading/brdf.h"
#include "shading/environment.h"
#include "shading/layers.h"
#include "shading/lighting.h"
#include "shading/shader.h"
#include "shading/surface.h"

namespace delray::shading {

// A surface as one viewer sees it.
struct Seen {
  glm::vec3 view;  // unit vector to the viewer
  Lobes lobes;
  Layers layers;
  Response response;  // below the layers
};

Seen seen_from(const Surface& surface, const glm::vec3& view);

// What the surface reflects diffusely of the environment, as if nothing stood around it.
glm::vec3 ambient_diffuse(const Shader& shader, const Surface& surface, const Seen& seen);

// What it mirrors of the environment, blurred by its roughness, what its coat does, and what it
// lets through from behind without bending: for renderers, and surfaces, that send no further rays.
glm::vec3 ambient_specular(const Shader& shader, const Surface& surface, const Seen& seen);
glm::vec3 ambient_coat(const Shader& shader, const Seen& seen);
glm::vec3 ambient_transmitted(const Shader& shader, const Surface& surface, const Seen& seen);

// reflect() of the surface and its layers.
inline glm::vec3 reflect(const Surface& surface, const Seen& seen, const glm::vec3& light) {
  const glm::vec3 base = reflect(seen.lobes, seen.response, surface.normal, seen.view, light);
  return base + reflect(seen.layers, surface.normal, seen.view, light);
}

// Light of all lights in ascending order. visibility(light number, incident) says how much of it
// arrives, as a glm::vec3 or a float from 0 to 1; it is asked only for light that would matter.
template <class Visibility>
glm::vec3 direct(const Shader& shader, const Surface& surface, const Seen& seen,
                 Visibility&& visibility) {
  glm::vec3 sum(0.0F);
  for (std::size_t i = 0; i < shader.lights.size(); ++i) {
    const Incident light = incident(shader.lights[i], surface.position);
    const glm::vec3 reflected = reflect(surface, seen, light.direction) * light.irradiance;
    if (reflected.x > 0.0F || reflected.y > 0.0F || reflected.z > 0.0F) {
      sum += reflected * visibility(i, light);
    }
  }
  return sum;
}

// Everything: emission, environment, lights. `view` is the unit vector to the viewer.
// Surface::alpha is the caller's to apply.
template <class Visibility>
glm::vec3 shade(const Shader& shader, const Surface& surface, const glm::vec3& view,
                Visibility&& visibility) {
  const Seen seen = seen_from(surface, view);
  glm::vec3 sum = surface.emission * seen.layers.below_coat;
  sum += ambient_diffuse(shader, surface, seen);
  sum += ambient_specular(shader, surface, seen);
  sum += ambient_coat(shader, seen);
  sum += ambient_transmitted(shader, surface, seen);
  sum += direct(shader, surface, seen, visibility);
  return sum;
}

}  // namespace delray::shading
