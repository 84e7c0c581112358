// Rectangles of pixels or grid cells, half-open, as every part of Delray passes them.
#pragma once

#include <algorithm>
#include <cstdint>

namespace delray::geometry {

// The cells (x, y) with x0 <= x < x1 and y0 <= y < y1; y grows downwards, as rows of an image do.
// Empty when x0 >= x1 or y0 >= y1.
struct Rect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return std::max(0, x1 - x0); }
  int height() const { return std::max(0, y1 - y0); }
  std::int64_t area() const { return std::int64_t{width()} * height(); }
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool operator==(const Rect&) const = default;
};

// The cells in both; empty (possibly with x0 > x1) when they are disjoint.
inline Rect intersection(const Rect& a, const Rect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace delray::geometry
