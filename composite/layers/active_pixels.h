// Loops over the covered pixels of a group, for ActiveLayer: SIMD through Highway, chosen at run
// time, for values of 4 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "composite/coverage.h"
#include "image/image.h"
#include "image/operators.h"

namespace delray::composite::internal {

inline constexpr std::size_t kMostLanes = 8;  // of vectors of 4-byte values

// Nothing that lies behind is seen.
inline bool hides(image::Rgba8 colour) { return colour.a == 255; }
inline bool hides(const image::RgbaF& colour) { return colour.a == 1; }

// Sets the bits of the pixels that have a depth and returns how many. REQUIRES: `mask` is zero and
// not smaller.
std::uint64_t find_covered(std::span<const float> depth, GroupMask& mask);

// Finds pixels that have a colour other than {}.
std::uint64_t find_coloured(std::span<const image::Rgba8> colour, GroupMask& mask);
std::uint64_t find_coloured(std::span<const image::RgbaF> colour, GroupMask& mask);

// Finds pixels of somebody else's: those nearer than `depth`, and those with an alpha that is not
// 0.
std::uint64_t find_nearer(std::span<const float> depths, float depth, GroupMask& mask);
std::uint64_t find_with_alpha(std::span<const image::Rgba8> colour, GroupMask& mask);
std::uint64_t find_with_alpha(std::span<const image::RgbaF> colour, GroupMask& mask);

// Copies the values of covered pixels to `to`, one after the other. `values` are those of all
// pixels of the group; size(to) of them are covered.
//
// REQUIRES: of a group whose size is no multiple of kMostLanes, values up to the next multiple may
// be read, too, as those of an image::Plane: whole vectors are loaded.
void compress(const std::uint32_t* values, const GroupMask& mask, std::span<std::uint32_t> to);
void compress(const image::Rgba8* values, const GroupMask& mask, std::span<image::Rgba8> to);
void compress(const float* values, const GroupMask& mask, std::span<float> to);
void compress(const image::RgbaF* values, const GroupMask& mask, std::span<image::RgbaF> to);

// The inverse: pixels of a group that are not covered get `nothing`, and kEmptyDepth. So many
// values may be read.
void expand(const image::Rgba8* values, std::size_t readable, const GroupMask& mask,
            image::Rgba8 nothing, std::span<image::Rgba8> to);
void expand(const image::RgbaF* values, std::size_t readable, const GroupMask& mask,
            image::RgbaF nothing, std::span<image::RgbaF> to);
void expand(const float* values, std::size_t readable, const GroupMask& mask, std::span<float> to);

// Unpacks what compress gave, of two planes.
template <class Colour>
struct ActivePixels {
  const Colour* colour;
  const float* depth;
  std::size_t readable;  // values that both pointers may be read at
};

// image::z_merge of covered pixels into the pixels of a group.
void z_merge(image::Rgba8* colour, float* depth, const GroupMask& mask,
             const ActivePixels<image::Rgba8>& other, image::Tie tie);
void z_merge(image::RgbaF* colour, float* depth, const GroupMask& mask,
             const ActivePixels<image::RgbaF>& other, image::Tie tie);

// image::blend_front of covered pixels into the pixels of a group of `size`, or blend_back.
void blend(image::Rgba8* colour, std::size_t size, const GroupMask& mask,
           const ActivePixels<image::Rgba8>& other, bool front);
void blend(image::RgbaF* colour, std::size_t size, const GroupMask& mask,
           const ActivePixels<image::RgbaF>& other, bool front);

}  // namespace delray::composite::internal
