// Batches of rays over a distributed scene: on their own rank they are intersected with what is
// resident, and only those that something else may be in the way of travel.
#pragma once

#include "raytrace/distributed/intersect_cluster.h"
#include "raytrace/distributed/ray_router.h"

namespace delray::raytrace {

// What the rays of a rank are intersected with, and who decides how they go on.
struct HomeScene {
  LocalScene resident;
  const shading::BatchShader& shader;
  Kernels kernels;
  const ClusterTree& elsewhere;
  const RayRouter& router;
};

// Intersects all rays of the batch and appends copies of those that are not decided to
// `travelling`; where they return to is filled into copies of `address`. Returns how many rays
// there were. One batch a thread.
std::uint64_t intersect_at_home(const HomeScene& home, const ReturnAddress& address,
                                RayBatch& batch, RayQueue& travelling);

// Completes a ray of the batch by what it found elsewhere.
void deliver(const RayMessage& ray, RayBatch& batch);
void deliver(const ShadowMessage& shadow, RayBatch& batch);

}  // namespace delray::raytrace
