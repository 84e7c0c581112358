// Writes the message of active-pixel layers, wherever the pixels come from.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "comm/buffer.h"
#include "composite/coverage.h"
#include "composite/layers/active_pixels.h"
#include "parallel/parallel_for.h"

namespace delray::composite::internal {

inline constexpr std::size_t kGroupsGrain = 4;  // groups of 4096 pixels; some ten microseconds

// Of a range with that coverage. view(begin, end) gives something with pointers `colour` and
// `depth` to the pixels of a group, which begins and ends there in the range; several threads call
// it. Without `has_depth` depths are not looked at.
template <class Colour, class View>
comm::Buffer encode_active(const Coverage& coverage, bool has_depth, View&& view) {
  const std::uint64_t covered = coverage.covered();
  comm::Buffer buffer(coverage.encoded_bytes() +
                      covered * (sizeof(Colour) + (has_depth ? sizeof(float) : 0)));
  auto* const colours = reinterpret_cast<Colour*>(coverage.encode(buffer.data()));
  auto* const depths = reinterpret_cast<float*>(colours + covered);
  parallel::parallel_for(0, coverage.groups(), kGroupsGrain, [&](std::size_t i) {
    const Coverage::Group at = coverage.group(i);
    if (at.covered == 0) return;
    const auto pixels = view(at.begin, at.end);
    const auto copy = [&]<class T>(const T* from, T* to) {
      if (at.is_full()) {
        std::copy_n(from, at.covered, to + at.covered_before);
      } else {
        compress(from, coverage.mask(i), std::span(to + at.covered_before, at.covered));
      }
    };
    copy(pixels.colour, colours);
    if (has_depth) copy(pixels.depth, depths);
  });
  return buffer;
}

}  // namespace delray::composite::internal
