// Fixed-point positions on the screen, and the tiles that the screen is cut into.
//
// Positions are in subpixels (1/256 of a pixel) from the screen's centre pixel, so that they fit
// the 24 bits of a float's mantissa all over the guard band, and y grows downwards.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/rect.h"
#include "scenes/camera.h"

namespace delray::raster {

inline constexpr int kSubpixelBits = 8;
inline constexpr int kSubpixels = 1 << kSubpixelBits;
inline constexpr int kHalfPixel = kSubpixels / 2;

// The guard band: triangles that stay within this many pixels of the centre are not clipped at the
// sides. Differences of coordinates are then below 2^24 subpixels, and an edge function that
// changes sign inside a tile is below 126 * 2^24 < 2^31 in all of it, see tile_triangle.h.
inline constexpr int kGuardPixels = 32767;
inline constexpr int kGuardSubpixels = kGuardPixels * kSubpixels;
// The largest width and height of a frame: all of it must lie in the guard band.
inline constexpr int kLargestSide = 2 * kGuardPixels;

// Tiles are squares of pixels, aligned to the screen's corner whatever a rank's regions are.
inline constexpr int kTileSize = 64;
inline constexpr int kTilePixels = kTileSize * kTileSize;

// A frame, or a window of one, as the rasterizer sees it. The bytes of a window are those of the
// frame there: what is rounded is relative to places of the frame, wherever the window lies.
struct Screen {
  scenes::View view;
  int width = 0, height = 0;
  geometry::Rect whole;              // the frame, in pixels of the window
  int centre_x = 0, centre_y = 0;    // the pixel that subpixel positions are relative to
  float offset_x = 0, offset_y = 0;  // of the view's axis from that pixel's corner, in subpixels
  int tiles_x = 0, tiles_y = 0;
  float samples = 1;  // per pixel of the picture, in either direction

  int tiles() const { return tiles_x * tiles_y; }
  geometry::Rect frame() const { return {0, 0, width, height}; }
  geometry::Rect tile(int index) const {
    const int x = index % tiles_x * kTileSize;
    const int y = index / tiles_x * kTileSize;
    return geometry::intersection({x, y, x + kTileSize, y + kTileSize}, frame());
  }
};

// REQUIRES: 1 <= view.width, view.height <= kLargestSide; view.near > 0 unless it is orthographic;
// the window is not empty and lies in the view's frame.
inline Screen make_screen(const scenes::View& view, const geometry::Rect& window) {
  Screen screen;
  screen.view = scenes::cropped(view, window);
  screen.width = window.width();
  screen.height = window.height();
  screen.whole = {-window.x0, -window.y0, view.width - window.x0, view.height - window.y0};
  screen.centre_x = view.width / 2 - window.x0;
  screen.centre_y = view.height / 2 - window.y0;
  screen.offset_x = (screen.view.half_width - static_cast<float>(screen.centre_x)) * kSubpixels;
  screen.offset_y = (screen.view.half_height - static_cast<float>(screen.centre_y)) * kSubpixels;
  screen.tiles_x = (screen.width + kTileSize - 1) / kTileSize;
  screen.tiles_y = (screen.height + kTileSize - 1) / kTileSize;
  return screen;
}
// Of all of the view's frame.
inline Screen make_screen(const scenes::View& view) {
  return make_screen(view, {0, 0, view.width, view.height});
}

// The distance along the view axis of a depth in the rasterizer's unit: -near / distance, or of an
// orthographic view from -1 at `near` to 0 at `far`. Both are planes over the screen.
inline float distance_of(float depth, const scenes::View& view) {
  return view.orthographic ? view.far + depth * (view.far - view.near) : -view.near / depth;
}

// The first pixel of an axis whose centre is at or after `subpixel`, and the last at or before it,
// relative to the centre pixel.
inline int first_centre(int subpixel) { return (subpixel + kHalfPixel - 1) >> kSubpixelBits; }
inline int last_centre(int subpixel) { return (subpixel - kHalfPixel) >> kSubpixelBits; }

}  // namespace delray::raster
