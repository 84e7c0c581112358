// Intersects rays with a scene that this rank holds whole.
#pragma once

#include "raytrace/scene/ray_batch.h"
#include "raytrace/tracer.h"
#include "shading/batch_shader.h"

namespace delray::raytrace {

// Intersects all rays of the batch, group by group as packets. `shader` is made of the tracer's.
void intersect(const Tracer& tracer, const shading::BatchShader& shader, RayBatch& batch);

// One thing that can be seen through and is in the way of light.
struct Layer {
  float distance = 0.0F;
  std::uint32_t instance = kMiss, triangle = kMiss;
  glm::vec3 transmittance{1.0F};  // what it leaves of light that travels through it
};

// The layer of a hit. `direction` is the unit direction of the shadow ray.
Layer layer_of(std::span<const GeometryInstance> instances, const shading::Shader& shader,
               const Hit& hit, const glm::vec3& direction, bool through_glass);

// The product of the transmittances of layers, multiplied in ascending order of (distance,
// instance, triangle), into which they are sorted.
glm::vec3 transmittance_of(std::span<Layer> layers);

}  // namespace delray::raytrace
