// A triangle's edge functions and depth plane, seen from one tile.
//
// The edge function from p to q at a point c is E(c) = (q-p).x * (c-p).y - (q-p).y * (c-p).x; it is
// positive on the inner side. Pixel centres are 256 subpixels apart, so on them E = 256 * (a*i +
// b*j)
// + C, and E > 0 (or >= 0 on a top or left edge) exactly where a*i + b*j + floor((C - bias) / 256)
// >= 0 with bias 0 on top and left edges and 1 on others: whole numbers, nothing is rounded.
//
// |a|, |b| < 2^24 by the guard band. An edge that is negative all over the tile rejects the
// triangle; one that is nowhere negative is replaced by the constant 0; any other has both signs,
// hence its values lie within 63 (|a| + |b|) < 2^31 and 32 bits suffice.
#pragma once

#include <algorithm>
#include <cstdint>

#include "raster/pipeline/screen_triangle.h"

namespace delray::raster {

struct TileTriangle {
  std::int32_t a[3], b[3], c[3];  // edge k at pixel (i, j) of the tile: a*i + b*j + c >= 0 inside
  // Depth at pixel (i, j): clamp((slope_x * (x + i) + slope_y * (y + j)) + depth, nearest,
  // farthest) with (x, y) the tile's first pixel centre seen from the triangle's first vertex, in
  // pixels.
  float x, y, slope_x, slope_y, depth, nearest, farthest;
};

// False where the triangle covers no pixel of the tile whose first pixel is (tile_x, tile_y).
inline bool make_tile_triangle(const ScreenTriangle& triangle, const Screen& screen, int tile_x,
                               int tile_y, TileTriangle& result) {
  const std::int32_t origin_x = (tile_x - screen.centre_x) * kSubpixels + kHalfPixel;
  const std::int32_t origin_y = (tile_y - screen.centre_y) * kSubpixels + kHalfPixel;
  const ScreenVertex* v = triangle.vertex;
  std::int32_t x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = v[k].x - origin_x;
    y[k] = v[k].y - origin_y;
  }
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    const std::int32_t dx = x[next] - x[k];
    const std::int32_t dy = y[next] - y[k];
    const bool top_left = dy < 0 || (dy == 0 && dx > 0);
    const std::int64_t at_origin = std::int64_t{dy} * x[k] - std::int64_t{dx} * y[k];
    const std::int64_t c = (at_origin - (top_left ? 0 : 1)) >> kSubpixelBits;
    constexpr std::int64_t kLast = kTileSize - 1;
    const std::int64_t step_x = -kLast * dy;
    const std::int64_t step_y = kLast * dx;
    if (c + std::max<std::int64_t>(step_x, 0) + std::max<std::int64_t>(step_y, 0) < 0) return false;
    const bool everywhere =
        c + std::min<std::int64_t>(step_x, 0) + std::min<std::int64_t>(step_y, 0) >= 0;
    result.a[k] = everywhere ? 0 : -dy;
    result.b[k] = everywhere ? 0 : dx;
    result.c[k] = everywhere ? 0 : static_cast<std::int32_t>(c);
  }

  // In double: the products of a sliver cancel, and its area may be a single unit.
  const double x1 = x[1] - x[0], x2 = x[2] - x[0];
  const double y1 = y[1] - y[0], y2 = y[2] - y[0];
  const double d1 = double{v[1].depth} - double{v[0].depth};
  const double d2 = double{v[2].depth} - double{v[0].depth};
  const double per_pixel = kSubpixels / (x1 * y2 - x2 * y1);
  result.slope_x = static_cast<float>((d1 * y2 - d2 * y1) * per_pixel);
  result.slope_y = static_cast<float>((d2 * x1 - d1 * x2) * per_pixel);
  result.depth = v[0].depth;
  result.x = static_cast<float>(-x[0]) * (1.0F / kSubpixels);
  result.y = static_cast<float>(-y[0]) * (1.0F / kSubpixels);
  result.nearest = std::min({v[0].depth, v[1].depth, v[2].depth});
  result.farthest = std::max({v[0].depth, v[1].depth, v[2].depth});
  return true;
}

inline bool covers(const TileTriangle& t, int i, int j) {
  return (t.a[0] * i + t.b[0] * j + t.c[0]) >= 0 && (t.a[1] * i + t.b[1] * j + t.c[1]) >= 0 &&
         (t.a[2] * i + t.b[2] * j + t.c[2]) >= 0;
}

inline float depth_at(const TileTriangle& t, int i, int j) {
  const float plane =
      (t.slope_x * (t.x + static_cast<float>(i)) + t.slope_y * (t.y + static_cast<float>(j))) +
      t.depth;
  return std::min(std::max(plane, t.nearest), t.farthest);
}

}  // namespace delray::raster
