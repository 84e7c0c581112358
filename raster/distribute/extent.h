// How much of the screen triangles take up.
#pragma once

#include "raster/pipeline/triangle_boxes.h"

namespace delray::raster {

// The pixels that the box of triangles touches, clipped to the frame, and how many of them may be
// seen. For costs: exact where nothing is clipped, but that of so many small clusters that follow
// each other in a mesh one is looked at, and what the others show is taken to be like it.
struct Extent {
  geometry::Rect box;
  std::uint64_t triangles = 0;
  // The sum of the areas of triangles that are not large, rounded up to one each.
  std::uint64_t pixels = 0;
};

// Finds extents, best one after the other along a mesh: the boxes of the last cluster's triangles
// are kept. One per thread.
class Extents {
 public:
  // One in so many neighbours is looked at.
  static constexpr std::uint32_t kMeasured = 32;

  // Refers to the screen.
  explicit Extents(const Screen& screen) : screen_(screen) {}

  // Of triangles [first, first + count) of a draw's mesh. Those with large boxes are appended to
  // `large`. REQUIRES: their clusters were made.
  Extent of(const PreparedDraw& draw, std::uint32_t first, std::uint32_t count,
            std::vector<ScreenTriangle>& large);

 private:
  bool lies_within(const geometry::Rect& pixels) const;
  void look_at(const PreparedDraw& draw, const ClusterBlock& block, const MeshCluster& cluster);
  void look_at_neighbours(const PreparedDraw& draw, const ClusterBlock& block, std::uint32_t part);
  bool estimate(const PreparedDraw& draw, const ClusterBlock& block, std::uint32_t part,
                Extent& result);

  const Screen& screen_;
  // The last cluster, and whether anything of it may be seen.
  const PreparedDraw* draw_ = nullptr;
  const MeshCluster* cluster_ = nullptr;
  bool may_be_seen_ = false;
  geometry::Rect bounds_;
  ScreenVertices vertices_;
  TriangleBoxes boxes_;  // if no vertex is outside
  SumOfBoxes sum_;       // the same
  // The clusters from `first` on, kMeasured of a block, and which of them stands for the others:
  // null where none can.
  struct Neighbours {
    const PreparedDraw* draw = nullptr;
    const MeshCluster *first = nullptr, *measured = nullptr;
    geometry::Rect bounds;
    SumOfBoxes sum;
  } neighbours_;
};

}  // namespace delray::raster
