// Rays put into the lanes of groups.
#pragma once

#include <algorithm>
#include <bit>
#include <glm/glm.hpp>
#include <limits>
#include <type_traits>

#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// Lamps are modelled around their lights; a shadow ray ends a little before it gets there.
inline constexpr float kShadowReach = 1.0F - 0x1p-10F;

inline constexpr std::uint32_t kMostLayers = 64;  // of cut-outs and blended surfaces along one ray

inline float brightest(const glm::vec3& v) { return std::max(std::max(v.x, v.y), v.z); }

// The least number above x. REQUIRES: x is finite and >= 0.
inline float next_up(float x) { return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + 1); }

template <class Group>
void clear_lanes(Group& group) {
  std::fill_n(group.active.ray, kPacketRays, 0);
  group.coherent = false;
  if constexpr (std::is_same_v<Group, RayGroup>) group.misses = false;
}

// Sets the fields that are equal in all rays that start at surfaces; no lane is active.
inline void clear_rays(RayGroup& group) {
  RayPacket& packet = group.packet;
  clear_lanes(group);
  std::fill_n(packet.near, kPacketRays, 0.0F);
  std::fill_n(packet.time, kPacketRays, 0.0F);
  std::fill_n(packet.far, kPacketRays, std::numeric_limits<float>::infinity());
  std::fill_n(packet.mask, kPacketRays, 0xFFFFFFFFU);
  std::fill_n(packet.id, kPacketRays, 0U);
  std::fill_n(packet.flags, kPacketRays, 0U);
  std::fill_n(packet.triangle, kPacketRays, kMiss);
  std::fill_n(packet.geometry, kPacketRays, kMiss);
  std::fill_n(packet.instance, kPacketRays, kMiss);
}
inline void clear_rays(ShadowGroup& group) {
  ShadowPacket& packet = group.packet;
  clear_lanes(group);
  group.through_glass = 0;
  std::fill_n(packet.near, kPacketRays, 0.0F);
  std::fill_n(packet.time, kPacketRays, 0.0F);
  std::fill_n(packet.mask, kPacketRays, 0xFFFFFFFFU);
  std::fill_n(packet.flags, kPacketRays, 0U);
}

// `direction` may have any length; `view` is the unit vector against it.
inline void set_ray(RayGroup& group, int i, const glm::vec3& origin, const glm::vec3& direction,
                    const glm::vec3& view, float near) {
  RayPacket& packet = group.packet;
  group.active.ray[i] = -1;
  packet.origin_x[i] = origin.x;
  packet.origin_y[i] = origin.y;
  packet.origin_z[i] = origin.z;
  packet.near[i] = near;
  packet.direction_x[i] = direction.x;
  packet.direction_y[i] = direction.y;
  packet.direction_z[i] = direction.z;
  packet.time[i] = 0.0F;
  packet.far[i] = std::numeric_limits<float>::infinity();
  packet.mask[i] = 0xFFFFFFFFU;
  packet.id[i] = packet.flags[i] = 0;
  packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  group.view.set(i, view);
}

inline glm::vec3 origin_of(const RayPacket& packet, int i) {
  return {packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]};
}
inline glm::vec3 direction_of(const RayPacket& packet, int i) {
  return {packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]};
}

}  // namespace delray::raytrace
