// Intersects rays with the geometry that this rank has: a whole scene, or some clusters of one.
#pragma once

#include <span>

#include "raytrace/scene/ray_batch.h"
#include "raytrace/tracer.h"
#include "shading/batch_shader.h"

namespace delray::raytrace {

// Intersects all rays of the batch, group by group as packets. `shader` is made of the tracer's.
void intersect(const Tracer& tracer, const shading::BatchShader& shader, RayBatch& batch);

// As above, of camera rays, of which some have their hits already: element i of `left` are those of
// group i that have none.
void intersect_rest(const Tracer& tracer, RayBatch& batch, std::span<const ActiveRays> left);

// Geometry at hand, with Embree's structure over it.
struct LocalScene {
  const EmbreeScene& embree;
  std::span<const GeometryInstance> instances;
  const shading::Shader& shader;
  std::span<const GeometryNumbers> numbers;  // in the whole scene; empty: this is the whole scene
  bool large;                                // is_large of its bytes
};

// The rays of the batch, but not its shadow rays. Hits tell what they are in `scene`.
void intersect_rays(const LocalScene& scene, RayBatch& batch);

// Traces shadow rays: sets `lit`, and what every one of them has passed. `coherent`: as packets.
void trace_shadows(const LocalScene& scene, bool coherent, ShadowGroup& group,
                   std::span<SeeThrough, kPacketRays> passed);

// Sets `attenuated` and the transmittances of those of `lanes`, a part of `lit`, that have passed
// something.
void attenuate(const LocalScene& scene, const shading::BatchShader& shader,
               std::span<const SeeThrough, kPacketRays> passed, shading::LaneMask lanes,
               ShadowGroup& group);

// One thing that can be seen through and is in the way of light.
struct Layer {
  float distance = 0.0F;
  std::uint32_t instance = kMiss, triangle = kMiss;
  glm::vec3 transmittance{1.0F};  // what it leaves of light that travels through it
};

// The layer of a hit, as it is in `instances`. `direction` is the unit direction of the shadow ray.
Layer layer_of(std::span<const GeometryInstance> instances, const shading::Shader& shader,
               const Hit& hit, const glm::vec3& direction, bool through_glass);

// As above, of a hit in `scene`, with what it is in the whole scene.
Layer layer_in_whole_scene(const LocalScene& scene, const Hit& hit, const glm::vec3& direction,
                           bool through_glass);

// The product of the transmittances of layers, multiplied in ascending order of (distance,
// instance, triangle), into which they are sorted.
glm::vec3 transmittance_of(std::span<Layer> layers);

}  // namespace delray::raytrace
