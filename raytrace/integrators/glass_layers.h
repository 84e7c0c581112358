// The part that panes of glass leave of the light of shadow rays, many at a time.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/ray.h"
#include "shading/batch_shader.h"

namespace delray::raytrace {

// A hit of a shadow ray, with the ray's unit direction.
struct PaneHit {
  Hit hit;
  glm::vec3 direction{0.0F};
  glm::vec3* transmittance = nullptr;  // where the answer goes
};

// Layer::transmittance of each, bit for bit what layer_of says of light that passes glass. `shader`
// is made of the shader's own materials. REQUIRES: the materials of all hits transmit.
void find_transmittances(std::span<const GeometryInstance> instances,
                         const shading::BatchShader& shader, std::span<const PaneHit> hits);

}  // namespace delray::raytrace
