// Cutting ranges of pixels, and the tags of compositing's messages.
#pragma once

#include <algorithm>
#include <cassert>

#include "comm/communicator.h"
#include "composite/layer.h"

namespace delray::composite::internal {

// One tag serves all rounds: every receive names its source, whose messages stay in order.
inline constexpr comm::Tag kTagCompose = 64;
inline constexpr comm::Tag kTagGatherRanges = 65;
inline constexpr comm::Tag kTagGatherPixels = 66;
inline constexpr comm::Tag kTagTile = 67;  // its number, followed by
inline constexpr comm::Tag kTagTilePixels = 68;
inline constexpr comm::Tag kTagTakingPart = 69;

// Piece i of `count` pieces of a range, as equal as they can be, cut between whole pixels. Empty
// where there are fewer pixels than pieces. REQUIRES: range.size() is a multiple of
// samples_per_pixel.
inline PixelRange piece_of(PixelRange range, int i, int count, int samples_per_pixel) {
  const auto samples = static_cast<std::uint64_t>(samples_per_pixel);
  assert(0 <= i && i < count && range.size() % samples == 0);
  const std::uint64_t units = range.size() / samples, pieces = static_cast<std::uint64_t>(count);
  const auto cut = [&](std::uint64_t k) { return range.begin + units * k / pieces * samples; };
  return {cut(static_cast<std::uint64_t>(i)), cut(static_cast<std::uint64_t>(i) + 1)};
}

inline PixelRange half_of(PixelRange range, int half, int samples_per_pixel) {
  return piece_of(range, half, 2, samples_per_pixel);
}

inline PixelRange overlap(PixelRange a, PixelRange b) {
  const std::uint64_t begin = std::max(a.begin, b.begin);
  return {begin, std::max(begin, std::min(a.end, b.end))};
}

}  // namespace delray::composite::internal
