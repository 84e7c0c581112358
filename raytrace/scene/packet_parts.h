// Packets of sixteen rays as packets of fewer, for processors whose vectors are shorter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// Calls f(active, rays) with kWidth rays of `packet` at a time, but for parts without any active
// ray: a copy that has all fields of `packet`, kWidth elements each, and is copied back. `Packet`
// is made of arrays of kPacketRays elements of 4 bytes.
template <int kWidth, class Packet, class F>
void for_each_part(const ActiveRays& active, Packet& packet, F&& f) {
  static_assert(kPacketRays % kWidth == 0);
  constexpr std::size_t kField = sizeof(ActiveRays), kPart = kWidth * sizeof(std::int32_t);
  constexpr std::size_t kFields = sizeof(Packet) / kField;
  for (int first = 0; first < kPacketRays; first += kWidth) {
    alignas(64) std::int32_t some[kWidth];
    std::memcpy(some, active.ray + first, kPart);
    if (std::ranges::all_of(some, [](std::int32_t ray) { return ray == 0; })) continue;
    alignas(64) std::byte part[kFields * kPart];
    std::byte* whole = reinterpret_cast<std::byte*>(&packet) + first * sizeof(std::int32_t);
    for (std::size_t i = 0; i < kFields; ++i) {
      std::memcpy(part + i * kPart, whole + i * kField, kPart);
    }
    f(some, part);
    for (std::size_t i = 0; i < kFields; ++i) {
      std::memcpy(whole + i * kField, part + i * kPart, kPart);
    }
  }
}

}  // namespace delray::raytrace
