// Rays on their way between ranks.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/distributed/cluster_tree.h"
#include "raytrace/integrators/intersect.h"
#include "shading/surface.h"

namespace delray::raytrace {

// Where the result of a ray belongs: lane `lane` of group `group` of a pixel_task of rank `rank`.
struct ReturnAddress {
  std::int32_t rank = 0;
  std::uint32_t pixel_task = 0, group = 0;
  std::uint8_t lane = 0;
  std::uint8_t coherent = 0;        // traced by the kernel for packets, wherever it comes
  std::uint8_t coloured : 1 = 0;    // Points::coloured of the answer
  std::uint8_t second_uvs : 1 = 0;  // Point::second of the answer is needed
  std::uint8_t through_glass = 0;   // of light: passes glass, unbent
};

// How far a ray has come: it has met all clusters up to `last`, in the order of ClusterTree::find.
struct Progression {
  ClusterHit last{-1.0F, 0};
  std::uint32_t next = kMiss;  // the cluster that it waits for; kMiss: none, it is done
  std::uint32_t hops = 0;      // ring: ranks that it has been at
  std::uint64_t stamp = 0;     // ring: what its own rank had been given when it left
};

// To its nearest hit, with the nearest so far and the point there.
struct RayMessage {
  ReturnAddress return_address;
  Progression way;
  glm::vec3 origin{0.0F};
  float near = 0.0F;
  glm::vec3 direction{0.0F};
  float far = 0.0F;  // of the nearest hit
  glm::vec3 view{0.0F};
  float width = 0.0F, spread = 0.0F;
  std::uint32_t instance = kMiss, triangle = kMiss;  // of the whole scene
  float u = 0.0F, v = 0.0F;
  std::uint32_t material = 0;
  float offset = 0.0F;
  shading::Point point;
};

// Past what can be seen through, as far as that is known.
struct ShadowMessage {
  ReturnAddress return_address;
  Progression way;
  glm::vec3 origin{0.0F};
  float near = 0.0F;
  glm::vec3 direction{0.0F};
  float far = 0.0F;
  bool occluded = false;
  std::uint8_t layers = 0;
  Layer layer[SeeThrough::kMost];
};

// Rays and shadow rays with the same destination.
struct RayQueue {
  std::vector<RayMessage> rays;
  std::vector<ShadowMessage> shadows;
  bool empty() const { return rays.empty() && shadows.empty(); }
  std::size_t size() const { return rays.size() + shadows.size(); }
};

}  // namespace delray::raytrace
