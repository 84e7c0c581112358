// What an integrator asks and is told: rays in groups of sixteen, a wave of groups at a time.
//
// Who answers needs the geometry, but no materials, textures or lights; who asks needs those, but
// no geometry. Between question and answer a wave may wait as long as it takes.
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
  // The question.
  ActiveRays active;
  RayPacket packet;          // near, far and a miss as the hit
  bool coherent = false;     // rays of neighbouring pixels, which stay together
  bool misses = false;       // known to meet nothing, as all of the scene is elsewhere
  shading::Vectors16 view;   // unit vectors back along the rays
  shading::Floats16 width;   // of the cone that stands for its pixel, where the ray starts
  shading::Floats16 spread;  // what the cone gains per unit of the packet's distances

  // The answer: the packet's hits, and for those lanes what shading looks at.
  shading::LaneMask hits = 0;
  alignas(64) std::uint32_t material[kPacketRays];
  shading::Points points;
  shading::Floats16 offset;  // Intersection::offset
};

// Sixteen rays that ask how much light comes along them.
struct ShadowGroup {
  // The question.
  ActiveRays active;
  ShadowPacket packet;
  bool coherent = false;
  shading::LaneMask through_glass = 0;  // lanes whose light passes glass, unbent

  // The answer. Nothing arrives in lanes outside `lit`; in lanes of `dimmed`, a part of those,
  // `left` says what surfaces that can be seen through leave of it, channel by channel.
  shading::LaneMask lit = 0, dimmed = 0;
  shading::Vectors16 left;
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

struct Wave {
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
