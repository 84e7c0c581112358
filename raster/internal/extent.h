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

// Finds extents, best one after the other along a mesh: the vertices of the last cluster are kept.
// One per thread.
class Extents {
 public:
  // Refers to the screen.
  explicit Extents(const Screen& screen) : screen_(screen) {}

  // Of triangles [first, first + count) of a draw's mesh. REQUIRES: their clusters were made.
  Extent of(const PreparedDraw& draw, std::uint32_t first, std::uint32_t count);

 private:
  const Screen& screen_;
  const PreparedDraw* draw_ = nullptr;
  const MeshCluster* cluster_ = nullptr;
  ScreenVertices vertices_;  // of the cluster
};

}  // namespace delray::raster
