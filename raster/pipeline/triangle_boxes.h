// Where the triangles of a cluster are on the screen, without drawing them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/pipeline/cluster_on_screen.h"

namespace delray::raster {

// Triangles whose box has more pixels are large: they may be anywhere in it.
inline constexpr std::int64_t kLargeBox = 64 * 64;

// By place in the cluster.
struct TriangleBoxes {
  // Vectors are stored past the end.
  static constexpr std::size_t kSize = kClusterTriangles + kCornerPadding;
  static constexpr std::int32_t kCulled = 0, kAlone = -1;

  // How many pixels the triangle may show: its area, rounded up, at most those of its box. kCulled
  // where set_up would hand on nothing; kAlone where the box is large, or too wide for 32 bits:
  // nothing else is known then.
  alignas(64) std::int32_t pixels[kSize];
  // The pixels whose centres lie in the box, clipped to the frame, ends excluded. Where the
  // triangle is culled or alone: begins at INT32_MAX, ends at INT32_MIN.
  alignas(64) std::int32_t x0[kSize], y0[kSize], x1[kSize], y1[kSize];
  bool any_alone = false;

  geometry::Rect box(std::size_t place) const {
    return {x0[place], y0[place], x1[place], y1[place]};
  }
};

// The sum over some places, those alone left out.
struct SumOfBoxes {
  geometry::Rect box;  // around all; empty where all are culled
  std::uint64_t triangles = 0, pixels = 0;
};

// Boxes of all its triangles. O(triangles), a few nanoseconds each.
//
// REQUIRES: !vertices.any_outside.
void find_boxes(const ClusterOnScreen& cluster, TriangleBoxes& boxes);

// The sum over places [begin, end). REQUIRES: begin <= end <= the cluster's triangles.
SumOfBoxes sum_of(const TriangleBoxes& boxes, std::uint32_t begin, std::uint32_t end);

}  // namespace delray::raster
