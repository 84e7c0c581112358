// The rays by which paths go on, packed into full groups, with the state of their paths beside
// them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raytrace/integrators/path_vertices.h"
#include "raytrace/integrators/wavefront_integrator.h"
#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// Two generations of rays of a task: those that are intersected, and those that are enqueued into
// `next` meanwhile. Keeps its memory from task to task.
class PathQueue {
 public:
  // REQUIRES: both outlive it.
  PathQueue(RayBatch& next, RayCounts& counts) : next_(next), counts_(counts) {}

  // Begins a task: next.rays are its primary rays, group g those of block g.
  void begin();
  // Begins to shade what was enqueued. REQUIRES: that is intersected, and next is empty.
  void begin_generation();

  // The lanes of groups that have been intersected, in their order.
  PathLanes& paths(std::size_t group) { return intersected_[group]; }
  Groups<PathLanes>& paths() { return intersected_; }
  const LightLanes& lights(std::size_t group) const { return intersected_lights_[group]; }
  // Of groups that are not intersected yet.
  Groups<PathLanes>& waiting() { return enqueued_; }
  Groups<LightLanes>& waiting_lights() { return enqueued_lights_; }

  // Enqueues the ray of lane i behind the surface that it has met.
  void go_behind(const RayGroup& group, const PathLanes& lanes, int i, const Hit& hit);
  // Enqueues rays that were scattered.
  void enqueue(const ScatteredRays& rays);
  // Enqueues shadow rays, of the lanes `lit` side by side, to the lights that were drawn for them.
  void enqueue(const LightRays& rays, shading::LaneMask lit, const LightSamples& lights);

 private:
  // A group of next_.rays whose lanes from `used` on are free.
  struct Filling {
    std::size_t group = 0;
    int used = kPacketRays;
  };

  void clear();
  // Makes `filling` a group with a free lane.
  void make_room(Filling& filling);
  void add_shadows();

  RayBatch& next_;
  RayCounts& counts_;
  Groups<PathLanes> enqueued_, intersected_;
  Groups<LightLanes> enqueued_lights_, intersected_lights_;
  Filling filling_, straight_;     // straight_: of rays that have not been turned aside
  int used_lights_ = kPacketRays;  // lanes of the last group of next_.shadows
};

}  // namespace delray::raytrace
