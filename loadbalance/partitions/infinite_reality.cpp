// The screen of InfiniteReality (Montrym et al. 1997): fine regions, assigned in an interlaced
// fashion whatever they cost, so fine that every renderer has an equal share of whatever is shown.
//
// Primitives touch the regions of many renderers then: they are broadcast (raster::Redistribution).
// O(blocks). Degenerate: where there are fewer blocks than kBlocksPerPart for each part their sides
// are halved until there are enough or they are pixels.
#include "loadbalance/partitions/interlaced_blocks.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {

Partition infinite_reality(const Costs& costs, geometry::Rect frame, int parts) {
  constexpr std::int64_t kBlocksPerPart = 16;
  check_costs(costs, frame, parts);
  if (frame.empty()) return {frame, {}};
  int side = kInfiniteRealitySide;
  const auto blocks = [&] {
    const std::int64_t columns = (frame.width() + side - 1) / side;
    return columns * ((frame.height() + side - 1) / side);
  };
  while (side > 1 && blocks() < kBlocksPerPart * parts) side /= 2;
  return interlaced_blocks(frame, parts, side);
}

}  // namespace delray::loadbalance::internal
