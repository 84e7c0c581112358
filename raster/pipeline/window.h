// A rectangle of the frame's pixels in somebody's memory.
#pragma once

#include <cstddef>

#include "image/image.h"
#include "raster/pipeline/screen.h"

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

// Memory of this thread for the tile that `rect` lies in, row by row; of any content.
template <class Colour>
Window<Colour> tile_window(const geometry::Rect& rect) {
  static thread_local image::BasicImage<Colour> of_thread(kTileSize, kTileSize);
  return {of_thread.colour.data(), of_thread.depth.data(), rect.x0 / kTileSize * kTileSize,
          rect.y0 / kTileSize * kTileSize, kTileSize};
}

}  // namespace delray::raster
