// One surface at one pixel, and the one order and arithmetic in which surfaces are blended.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>

#include "image/image.h"

namespace delray::composite {

// Travels as it is: without gaps, a multiple of four bytes. `Payload` is what the surface looks
// like, its colour or whatever colour will be computed from by the owner of the pixel (as PixelFlow
// does, Molnar, Eyles and Poulton 1992). Beside Payload, in its namespace, stands
//
//   bool is_opaque(const Payload&);  // nothing behind it is seen
template <class Payload>
struct DeepFragment {
  static_assert(std::is_trivially_copyable_v<Payload>);
  static_assert(alignof(Payload) <= 4 && sizeof(Payload) % 4 == 0);

  Payload payload;
  float depth = 0;  // not NaN
  std::uint32_t primitive_low = 0, primitive_high = 0;

  std::uint64_t primitive() const {
    return std::uint64_t{primitive_high} << 32 | std::uint64_t{primitive_low};
  }
};

// Front to back, ties by primitive number. No two fragments of a pixel have both in common.
template <class Payload>
bool in_front(const DeepFragment<Payload>& a, const DeepFragment<Payload>& b) {
  return a.depth != b.depth ? a.depth < b.depth : a.primitive() < b.primitive();
}

// A surface whose colour is known.
using Fragment = DeepFragment<image::RgbaF>;
static_assert(sizeof(Fragment) == 28);

inline bool is_opaque(const image::RgbaF& colour) { return colour.a >= 1.0F; }

// The colour of a pixel: its fragments, in order, blended front to back in linear light. That of a
// single fragment is kept exactly; of none, {}.
inline image::RgbaF blend(std::span<const Fragment> in_order) {
  image::RgbaF sum;
  float through = 1;
  for (const Fragment& fragment : in_order) {
    sum.r += through * fragment.payload.r;
    sum.g += through * fragment.payload.g;
    sum.b += through * fragment.payload.b;
    sum.a += through * fragment.payload.a;
    through *= 1.0F - fragment.payload.a;
  }
  return sum;
}

// The result of blend as a pixel stores it: as it is, or as 8-bit sRGB, each channel clamped.
void store(const image::RgbaF& colour, image::RgbaF& pixel);
void store(const image::RgbaF& colour, image::Rgba8& pixel);

}  // namespace delray::composite
