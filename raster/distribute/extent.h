// How much of the screen triangles take up.
#pragma once

#include "raster/pipeline/prepared_draw.h"

namespace delray::raster {

// The pixels that the box of triangles touches, clipped to the frame, and how many of them may be
// seen. For costs: exact where nothing is clipped.
struct Extent {
  geometry::Rect box;
  std::uint64_t triangles = 0;
  // Of the areas of triangles that are not large, rounded up to one each.
  std::uint64_t pixels = 0;
};

// Triangles whose box has more pixels are large: they may be anywhere in it.
inline constexpr std::int64_t kLargeBox = 64 * 64;

// Finds extents, best one after the other along a mesh: the vertices of the last cluster are kept.
// One per thread.
class Extents {
 public:
  // Refers to the screen.
  explicit Extents(const Screen& screen) : screen_(screen) {}

  // Of triangles [first, first + count) of a draw's mesh. Those with large boxes are appended to
  // `large`. REQUIRES: their clusters were made.
  Extent of(const PreparedDraw& draw, std::uint32_t first, std::uint32_t count,
            std::vector<ScreenTriangle>& large);

 private:
  const Screen& screen_;
  const PreparedDraw* draw_ = nullptr;
  const MeshCluster* cluster_ = nullptr;
  ScreenVertices vertices_;  // of the cluster
};

}  // namespace delray::raster
