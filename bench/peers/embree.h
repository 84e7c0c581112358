// Bare Embree: loops over recorded rays that do nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "raytrace/scene/geometry_instance.h"

namespace delray::bench {

// Sixteen rays; unused lanes have near > far.
struct alignas(64) RecordedGroup {
  float origin_x[16], origin_y[16], origin_z[16], near[16];
  float direction_x[16], direction_y[16], direction_z[16], far[16];
};

enum class Loop : std::uint8_t {
  single,    // rtcIntersect1, rtcOccluded1
  packet,    // rtcIntersect16, rtcOccluded16; of 8 or 4 rays where Embree has no wider packets
  coherent,  // the same, told that the rays stay together
  stream,    // rtcIntersect1M, rtcOccluded1M over 256 rays
};
inline constexpr Loop kLoops[] = {Loop::single, Loop::packet, Loop::coherent, Loop::stream};
const char* name_of(Loop loop);

class BareEmbree {
 public:
  // An acceleration structure of its own over the same triangles, instances as instances. `isa` may
  // be empty. Coherent loops of shadow rays over instances are left out where Embree hangs in them.
  // The structure has Embree's default flags, and shadow rays end at whatever they meet. With
  // `same_answers` it is robust, and they pass what can be seen through, unnoted.
  BareEmbree(std::span<const raytrace::GeometryInstance> instances, bool same_answers,
             const char* isa);
  ~BareEmbree();

  bool can(Loop loop, bool shadows) const;

  // Seconds for all rays, with threads that stay awake. `shadows`: any hit will do.
  double seconds(std::span<const RecordedGroup> rays, bool shadows, Loop loop, int threads) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delray::bench
