// How much of the screen triangles take up.
#pragma once

#include "raster/internal/prepared_draw.h"

namespace delray::raster {

// The pixels that the box of triangles touches, clipped to the frame, and how many of them may be
// seen. For costs: exact where nothing is clipped.
struct Extent {
  geometry::Rect box;
  std::uint64_t triangles = 0;
  std::uint64_t pixels = 0;  // of the triangles' own areas, rounded up to one each
};

// Of triangles [first, first + count) of a draw's mesh. One thread.
//
// REQUIRES: their clusters were made.
Extent extent(const Screen& screen, const PreparedDraw& draw, std::uint32_t first,
              std::uint32_t count);

}  // namespace delray::raster
