// Operators that merge two partial images pixel by pixel: the z-test and the over operator.
//
// SIMD through Highway, chosen at run time, with the same bytes on every instruction set. The
// spans of a call have equal sizes; `other` may be unaligned but must not overlap the target.
// O(n) at memory speed, one thread.
#pragma once

#include <span>

#include "image/image.h"

namespace delray::image {

// Which side keeps a pixel whose depths are equal (-0 equals 0).
enum class Tie : unsigned char { target, other };

// Puts into the target, pixel by pixel, whichever of the two is nearer: colour and depth. Where
// both are empty their depths are equal, so `tie` decides on the colour as well.
//
// REQUIRES: no depth is NaN.
void z_merge(std::span<Rgba8> colour, std::span<float> depth, std::span<const Rgba8> other_colour,
             std::span<const float> other_depth, Tie tie);
void z_merge(std::span<RgbaF> colour, std::span<float> depth, std::span<const RgbaF> other_colour,
             std::span<const float> other_depth, Tie tie);

// target = front over target, for premultiplied colours (Porter & Duff 1984): each channel is
// front + target * (1 - front.a).
//
// Float: one multiplication and one addition, each rounded. 8 bits: the product divided by 255 is
// rounded to the nearest integer (exact, no ties occur), the sum saturates at 255. The codes are
// blended as they are: right for layers that were multiplied by alpha after coding, as programs
// that draw in 8 bits do; blend in RgbaF where light must add up.
void blend_front(std::span<Rgba8> target, std::span<const Rgba8> front);
void blend_front(std::span<RgbaF> target, std::span<const RgbaF> front);

// target = target over back; otherwise as blend_front.
void blend_back(std::span<Rgba8> target, std::span<const Rgba8> back);
void blend_back(std::span<RgbaF> target, std::span<const RgbaF> back);

}  // namespace delray::image
