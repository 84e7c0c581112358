// Triangles on the screen: what setup hands to the tiles.
#pragma once

#include <cstdint>
#include <utility>

#include "raster/pipeline/screen.h"

namespace delray::raster {

// A transformed vertex. `depth` is -near / distance along the view axis: from -1 at the near plane
// to 0 at infinity, linear on the screen. x is kOutside where the vertex lies before the near
// plane, outside the guard band, or is not finite; the rest is undefined then.
struct ScreenVertex {
  std::int32_t x = 0, y = 0;  // subpixels
  float depth = 0;
};
inline constexpr std::int32_t kOutside = INT32_MIN;

// A triangle with positive area: its edge functions are positive inside.
struct ScreenTriangle {
  ScreenVertex vertex[3];
  std::uint32_t number = 0;  // of the primitive it comes from, within the draw list
};
static_assert(sizeof(ScreenTriangle) == 40);

// Twice the signed area in square subpixels; positive where the vertices run clockwise as seen on
// the screen (y grows downwards). Exact: coordinates are below 2^23.
inline std::int64_t doubled_area(const ScreenVertex& a, const ScreenVertex& b,
                                 const ScreenVertex& c) {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{c.x - a.x} * (b.y - a.y);
}

// The pixels, clipped to `frame`, whose centres lie in the box of the triangle.
inline geometry::Rect centres_in_box(const ScreenVertex& a, const ScreenVertex& b,
                                     const ScreenVertex& c, const Screen& screen) {
  const auto [x_low, x_high] = std::minmax({a.x, b.x, c.x});
  const auto [y_low, y_high] = std::minmax({a.y, b.y, c.y});
  return geometry::intersection(
      {first_centre(x_low) + screen.centre_x, first_centre(y_low) + screen.centre_y,
       last_centre(x_high) + screen.centre_x + 1, last_centre(y_high) + screen.centre_y + 1},
      screen.frame());
}

}  // namespace delray::raster
