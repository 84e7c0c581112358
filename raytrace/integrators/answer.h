// Answers from a scene that this rank holds whole.
#pragma once

#include "raytrace/scene/wave.h"
#include "raytrace/tracer.h"
#include "shading/batch_shader.h"

namespace delray::raytrace {

// Answers all questions of the wave, group by group as packets. `shader` is made of the tracer's.
void answer(const Tracer& tracer, const shading::BatchShader& shader, Wave& wave);

// One thing that can be seen through and is in the way of light.
struct Layer {
  float distance = 0.0F;
  std::uint32_t placement = kMiss, triangle = kMiss;
  glm::vec3 left{1.0F};  // what it leaves of light that travels through it
};

// The layer of a hit. `direction` is the unit direction of the shadow ray.
Layer layer_of(std::span<const Placement> placements, const shading::Shader& shader, const Hit& hit,
               const glm::vec3& direction, bool through_glass);

// What layers leave of the light together, multiplied in ascending order of (distance, placement,
// triangle), into which they are sorted.
glm::vec3 left_by(std::span<Layer> layers);

}  // namespace delray::raytrace
