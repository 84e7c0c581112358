// Rays and their hits in groups of sixteen, a batch of groups at a time.
//
// Whoever intersects a batch needs the geometry, but no materials, textures or lights; the
// integrator needs those, but no geometry. A batch may wait for its hits as long as it takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raytrace/scene/ray.h"
#include "shading/points.h"

namespace delray::raytrace {

// Sixteen rays, each to its nearest hit. Lane i is ray i everywhere; lanes that are not active hold
// anything.
struct RayGroup {
  // Input.
  ActiveRays active;
  RayPacket packet;          // near, far and a miss as the hit
  bool coherent = false;     // rays of neighbouring pixels, which stay together
  bool misses = false;       // known to meet nothing, as all of the scene is elsewhere
  shading::Vectors16 view;   // unit vectors back along the rays
  shading::Floats16 width;   // of the cone that stands for its pixel, where the ray starts
  shading::Floats16 spread;  // what the cone gains per unit of the packet's distances

  // Result: the packet's hits, and for those lanes the values that shading needs.
  shading::LaneMask hits = 0;
  alignas(64) std::uint32_t material[kPacketRays];
  shading::Points points;
  shading::Floats16 offset;  // Intersection::offset
};

// Sixteen shadow rays: how much light comes along them.
struct ShadowGroup {
  // Input.
  ActiveRays active;
  ShadowPacket packet;
  bool coherent = false;
  shading::LaneMask through_glass = 0;  // lanes whose light passes glass, unbent

  // Result. Nothing arrives in lanes outside `lit`; in lanes of `attenuated`, a part of those,
  // `transmittance` says what surfaces that can be seen through leave of it, channel by channel.
  shading::LaneMask lit = 0, attenuated = 0;
  shading::Vectors16 transmittance;
};

// A list that keeps its elements, as they are, when it is cleared.
template <class T>
class Groups {
 public:
  // Not initialized. Invalidates references to elements.
  T& add() {
    if (size_ == all_.size()) all_.emplace_back();
    return all_[size_++];
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return all_[i]; }
  const T& operator[](std::size_t i) const { return all_[i]; }
  T& back() { return all_[size_ - 1]; }
  T* begin() { return all_.data(); }
  T* end() { return all_.data() + size_; }

 private:
  std::vector<T> all_;
  std::size_t size_ = 0;
};

struct RayBatch {
  Groups<RayGroup> rays;
  Groups<ShadowGroup> shadows;
  bool empty() const { return rays.empty() && shadows.empty(); }
  void clear() {
    rays.clear();
    shadows.clear();
  }
};

// Rays as a mask of lanes.
inline shading::LaneMask active_lanes(const ActiveRays& active) {
  shading::LaneMask mask = 0;
  for (int i = 0; i < kPacketRays; ++i) mask |= active.ray[i] != 0 ? 1U << i : 0U;
  return mask;
}

}  // namespace delray::raytrace
