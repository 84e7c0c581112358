// Rays on their way between ranks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
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
  std::uint8_t coherent : 1 = 0;       // traced by the kernel for packets, wherever it comes
  std::uint8_t through_glass : 1 = 0;  // of light: passes glass, unbent
  // Results so far.
  std::uint8_t found : 1 = 0;       // another rank has found a nearer hit: the point is known
  std::uint8_t coloured : 1 = 0;    // Points::coloured of the point
  std::uint8_t second_uvs : 1 = 0;  // Point::second of the point is needed
  std::uint8_t occluded : 1 = 0;    // of light: nothing arrives
  std::uint8_t layers = 0;          // of light: how many it has passed
};

// How far a ray has come: it has been intersected with all clusters up to `last`, in the order of
// ClusterTree::next, and with some others.
struct Progression {
  static constexpr std::uint32_t kKnown = 4;

  ClusterHit last{-1.0F, 0};
  std::uint32_t next = kMiss;  // the cluster that it waits for; kMiss: none, it is done
  std::uint32_t hops = 0;      // ring: from its own rank to the one that it is at or goes to

  // The last few ranks that it has been at. A ray that goes to an earlier one once more learns
  // nothing there, and loses nothing.
  std::int32_t been_at[kKnown] = {-1, -1, -1, -1};
  // The last few clusters that it has been intersected with alone.
  std::uint32_t met[kKnown] = {kMiss, kMiss, kMiss, kMiss};
  std::uint16_t next_rank = 0, next_met = 0;

  bool has_been_at(int rank) const {
    return been_at[0] == rank || been_at[1] == rank || been_at[2] == rank || been_at[3] == rank;
  }
  // Of so many ranks. May say no where there are more than it remembers.
  bool has_been_everywhere(int ranks) const {
    int rank = 0;
    while (rank < ranks && has_been_at(rank)) ++rank;
    return rank == ranks;
  }
  void note(int rank) {
    if (has_been_at(rank)) return;
    been_at[next_rank] = rank;
    next_rank = (next_rank + 1) % kKnown;
  }
  bool has_met(std::uint32_t cluster) const {
    return met[0] == cluster || met[1] == cluster || met[2] == cluster || met[3] == cluster;
  }
  void note_met(std::uint32_t cluster) {
    met[next_met] = cluster;
    next_met = (next_met + 1) % kKnown;
  }
};

// A ray of any kind, as it travels.
struct TravellingRay {
  Progression way;
  glm::vec3 origin{0.0F};
  float near = 0.0F;
  glm::vec3 direction{0.0F};
};

// The nearest hit so far, whoever found it.
struct NearestHit {
  float far = 0.0F;                                  // where there is none, the end of the ray
  std::uint32_t instance = kMiss, triangle = kMiss;  // of the whole scene
};

// What shading needs of a hit.
struct HitPoint {
  float u = 0.0F, v = 0.0F;
  std::uint32_t material = 0;
  float offset = 0.0F;
  shading::Point point;
};

// To its nearest hit. The ray's own rank keeps the point of the hit that it found itself.
struct RayMessage {
  ReturnAddress return_address;
  NearestHit nearest;
  TravellingRay ray;
  glm::vec3 view{0.0F};
  float width = 0.0F, spread = 0.0F;
  std::unique_ptr<HitPoint> hit;  // where return_address.found
};

// Past what can be seen through, as far as that is known.
struct ShadowMessage {
  ReturnAddress return_address;
  TravellingRay ray;
  float far = 0.0F;
  std::vector<Layer> layers;  // at most SeeThrough::kMost
};

// Rays and shadow rays with the same destination.
struct RayQueue {
  std::vector<RayMessage> rays;
  std::vector<ShadowMessage> shadows;
  bool empty() const { return rays.empty() && shadows.empty(); }
  std::size_t size() const { return rays.size() + shadows.size(); }
  void push(RayMessage&& ray) { rays.push_back(std::move(ray)); }
  void push(ShadowMessage&& shadow) { shadows.push_back(std::move(shadow)); }
  // Moves all of `more` behind what is there.
  void append(RayQueue&& more) {
    std::move(more.rays.begin(), more.rays.end(), std::back_inserter(rays));
    std::move(more.shadows.begin(), more.shadows.end(), std::back_inserter(shadows));
    more.clear();
  }
  void clear() {
    rays.clear();
    shadows.clear();
  }
};

inline float far_of(const RayMessage& ray) { return ray.nearest.far; }
inline float far_of(const ShadowMessage& shadow) { return shadow.far; }

}  // namespace delray::raytrace
