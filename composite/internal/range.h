// Cutting ranges of pixels, and the tags of compositing's messages.
#pragma once

#include <cassert>

#include "comm/communicator.h"
#include "composite/layer.h"

namespace delray::composite::internal {

// One tag serves all rounds: every receive names its source, whose messages stay in order.
inline constexpr comm::Tag kTagCompose = 64;
inline constexpr comm::Tag kTagGatherRanges = 65;
inline constexpr comm::Tag kTagGatherPixels = 66;

// Half `half` (0 or 1) of a range, cut between whole pixels; the second is the larger by one where
// they cannot be equal. REQUIRES: range.size() is a multiple of samples_per_pixel.
inline PixelRange half_of(PixelRange range, int half, int samples_per_pixel) {
  const auto samples = static_cast<std::uint64_t>(samples_per_pixel);
  assert(range.size() % samples == 0);
  const std::uint64_t middle = range.begin + range.size() / samples / 2 * samples;
  return half == 0 ? PixelRange{range.begin, middle} : PixelRange{middle, range.end};
}

}  // namespace delray::composite::internal
