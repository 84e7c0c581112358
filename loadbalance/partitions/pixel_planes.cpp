// The screen of Pixel-Planes 5 (Fuchs et al. 1989): square regions of 128 pixels, the one with the
// highest estimated cost first to the renderer that has least (largest first: Graham 1969).
//
// So no renderer has more than an equal share and the costliest region together.
// O(cells + boxes + blocks log blocks). Degenerate: where there are fewer blocks than parts their
// sides are halved until there are not.
#include "loadbalance/partition.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {

Partition pixel_planes(const Costs& costs, geometry::Rect frame, int parts) {
  check_costs(costs, frame, parts);
  const auto blocks_of = [&](int side) {
    const std::int64_t columns = (frame.width() + side - 1) / side;
    return columns * ((frame.height() + side - 1) / side);
  };
  int side = kPixelPlanesSide;
  while (side > 1 && blocks_of(side) < parts) side /= 2;
  Partition blocks{frame, {}};
  int number = 0;
  for (int y = frame.y0; y < frame.y1; y += side) {
    for (int x = frame.x0; x < frame.x1; x += side) {
      const geometry::Rect block{x, y, x + side, y + side};
      blocks.regions.push_back({geometry::intersection(block, frame), number++});
    }
  }
  return assign_largest_first(costs, blocks, parts);
}

}  // namespace delray::loadbalance::internal
