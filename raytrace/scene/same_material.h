// Hits of a group by material.
#pragma once

#include <bit>
#include <cstdint>

#include "raytrace/scene/ray_batch.h"

namespace delray::raytrace {

// The lanes of `rest` whose hits have the same material as the first of them. REQUIRES: rest != 0.
inline shading::LaneMask same_material(const RayGroup& group, shading::LaneMask rest) {
  const std::uint32_t material = group.material[std::countr_zero(rest)];
  shading::LaneMask same = 0;
  for (int i = 0; i < kPacketRays; ++i) same |= group.material[i] == material ? 1U << i : 0U;
  return same & rest;
}

}  // namespace delray::raytrace
