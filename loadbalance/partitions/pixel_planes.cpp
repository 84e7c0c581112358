// The screen of Pixel-Planes 5 (Fuchs et al. 1989): square regions of 128 pixels, the one with the
// highest estimated cost first to the renderer that has least (largest first: Graham 1969).
//
// So no renderer has more than an equal share and the costliest region together.
// O(cells + boxes + blocks log blocks). Degenerate: with fewer blocks than parts some have none.
#include "loadbalance/partition.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {

Partition pixel_planes(const Costs& costs, geometry::Rect frame, int parts) {
  check_costs(costs, frame, parts);
  Partition blocks{frame, {}};
  int number = 0;
  for (int y = frame.y0; y < frame.y1; y += kPixelPlanesSide) {
    for (int x = frame.x0; x < frame.x1; x += kPixelPlanesSide) {
      const geometry::Rect block{x, y, x + kPixelPlanesSide, y + kPixelPlanesSide};
      blocks.regions.push_back({geometry::intersection(block, frame), number++});
    }
  }
  return assign_largest_first(costs, blocks, parts);
}

}  // namespace delray::loadbalance::internal
