// A rectangle of the frame's pixels in somebody's memory.
#pragma once

#include <cstddef>

#include "image/image.h"

namespace delray::raster {

// Pixel (x, y) of the frame, or sample of it, is element at(x, y) of both planes.
template <class Colour>
struct Window {
  Colour* colour = nullptr;
  float* depth = nullptr;
  int x0 = 0, y0 = 0;  // element 0
  int stride = 0;      // from one row to the next

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(x - x0);
  }
};

// All of an image of the frame.
template <class Colour>
Window<Colour> window_of(image::BasicImage<Colour>& image) {
  return {image.colour.data(), image.depth.data(), 0, 0, image.width};
}

}  // namespace delray::raster
