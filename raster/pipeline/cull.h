// Bounds and culling of a whole cluster before its vertices are transformed.
#pragma once

#include "raster/pipeline/prepared_draw.h"

namespace delray::raster {

// Where the box of a cluster is on the screen.
struct ClusterBounds {
  bool outside = false;  // nothing of it can be seen
  // Pixels of the frame that it may touch, and the least depth that it may have; all of the frame
  // and -1 where it reaches before the near plane.
  geometry::Rect pixels;
  float nearest = -1;
  float farthest_distance = 0;  // along the view axis
};

// Conservative: rounding, and snapping to subpixels, are allowed for.
ClusterBounds bound(const Screen& screen, const PreparedDraw& draw, const geometry::Box3& box);

// Whether every triangle shows its hidden side, whatever snapping does to it. False where that is
// not certain, or no side is hidden.
bool shows_hidden_side_only(const Screen& screen, const PreparedDraw& draw,
                            const MeshCluster& cluster, const ClusterBounds& bounds);

}  // namespace delray::raster
