// Rays against one cluster.
#pragma once

#include "raytrace/distributed/cluster.h"
#include "raytrace/distributed/ray_message.h"
#include "shading/shader.h"

namespace delray::raytrace {

// What the whole scene decides about kernels, so that a ray is traced by the same one everywhere.
struct Kernels {
  bool has_instances = false;
};

// Brings all rays that wait up to date with the cluster. Of equally near hits the one with the
// lowest instance and triangle counts, whichever cluster came first.
void intersect_cluster(const Cluster& cluster, const shading::Shader& shader,
                       const Kernels& kernels, RayQueue& waiting);

}  // namespace delray::raytrace
