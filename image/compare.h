// Comparing two pictures of one size.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace delray::image {

// The number of pixels in which two pictures differ, and by how much.
struct Comparison {
  std::uint64_t colour_differs = 0;    // pixels whose colour or alpha is not bitwise equal
  std::uint64_t depth_differs = 0;     // pixels whose depth is not bitwise equal
  std::uint64_t coverage_differs = 0;  // pixels that only one of the pictures covers (depth < inf)
  // The largest difference of a channel: in codes for 8-bit pictures, in linear light for float
  // ones (infinite where exactly one of the two is NaN or they are different infinities).
  double max_channel_difference = 0;
  bool equal() const { return colour_differs == 0 && depth_differs == 0; }
};

// REQUIRES: equal width and height. O(pixels), parallel.
Comparison compare(const Image8& a, const Image8& b);
Comparison compare(const ImageF& a, const ImageF& b);

// The absolute difference of each colour channel as a code, times `gain` and clamped; opaque, with
// pixels that differ in alpha only in blue. Equal pictures give black.
//
// REQUIRES: equal width and height; gain >= 1.
Image8 difference_picture(const Image8& a, const Image8& b, int gain = 8);

}  // namespace delray::image
