// The rectangle around the covered pixels of a range, and the pixels of the range in it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "composite/coverage.h"
#include "composite/schemes/range.h"

namespace delray::composite::internal {

// Columns x0 <= x < x1 and rows y0 <= y < y1 of an image; as it travels.
struct Bounds {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// Around the covered pixels of `range` of an image that is `width` pixels wide; all 0 without any.
// find(begin, end, mask) sets the bits of those of [begin, end), of a mask that is zero, and
// returns how many there are. O(pixels of the range).
template <class Find>
Bounds bounds_of(PixelRange range, std::uint64_t width, Find&& find) {
  Bounds bounds{~std::uint32_t{0}, ~std::uint32_t{0}, 0, 0};
  const auto include = [&](std::uint64_t first, std::uint64_t last) {
    bounds.y0 = std::min(bounds.y0, static_cast<std::uint32_t>(first / width));
    bounds.y1 = std::max(bounds.y1, static_cast<std::uint32_t>(last / width + 1));
    const bool one_row = first / width == last / width;
    const auto x0 = one_row ? first % width : 0, x1 = one_row ? last % width + 1 : width;
    bounds.x0 = std::min(bounds.x0, static_cast<std::uint32_t>(x0));
    bounds.x1 = std::max(bounds.x1, static_cast<std::uint32_t>(x1));
  };
  for (std::uint64_t begin = range.begin; begin < range.end;) {
    // Groups end with rows, so that the first and last covered pixels of one tell its columns.
    const std::uint64_t end =
        std::min({begin + kGroupPixels, range.end, (begin / width + 1) * width});
    GroupMask mask{};
    if (find(begin, end, mask) > 0) {
      std::size_t first = 0, last = mask.size() - 1;
      while (mask[first] == 0) ++first;
      while (mask[last] == 0) --last;
      include(begin + first * 64 + static_cast<std::uint64_t>(std::countr_zero(mask[first])),
              begin + last * 64 + 63 - static_cast<std::uint64_t>(std::countl_zero(mask[last])));
    }
    begin = end;
  }
  return bounds.y1 == 0 ? Bounds{} : bounds;
}

// The pixels of `range` that lie in `bounds` on one of its rows.
inline PixelRange run_of(const Bounds& bounds, std::uint32_t y, std::uint64_t width,
                         PixelRange range) {
  return overlap({y * width + bounds.x0, y * width + bounds.x1}, range);
}

// The number of pixels of `range` that lie in `bounds`. O(rows).
inline std::uint64_t pixels_in(const Bounds& bounds, std::uint64_t width, PixelRange range) {
  std::uint64_t pixels = 0;
  for (std::uint32_t y = bounds.y0; y < bounds.y1; ++y) {
    pixels += run_of(bounds, y, width, range).size();
  }
  return pixels;
}

}  // namespace delray::composite::internal
