// Travelling rays against clusters at hand.
#pragma once

#include <span>

#include "raytrace/distributed/cluster_scene.h"
#include "raytrace/distributed/ray_message.h"
#include "shading/shader.h"

namespace delray::raytrace {

// What the whole scene decides about kernels, so that a ray is traced by the same one everywhere.
struct Kernels {
  bool has_instances = false;
};

// Brings all rays up to date with the clusters of a scene. Of equally near hits the one with the
// lowest instance and triangle counts, whichever cluster came first.
void intersect_clusters(const ClusterScene& clusters, const shading::Shader& shader,
                        const Kernels& kernels, std::span<RayMessage> rays,
                        std::span<ShadowMessage> shadows);

}  // namespace delray::raytrace
