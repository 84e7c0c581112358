// Square blocks of a size that gives every owner some, assigned in turn. O(blocks). Degenerate: a
// frame with fewer pixels than blocks are wanted has blocks of one pixel.
#include <algorithm>
#include <cstdint>

#include "loadbalance/partitions/interlaced_blocks.h"
#include "loadbalance/partitions/partitioners.h"

namespace delray::loadbalance::internal {
namespace {

using geometry::Rect;

constexpr std::int64_t kBlocksPerPart = 16;

// The side of a block in pixels; a multiple of 16, or at least of 4, which tiles of renderers
// divide, where it is that large.
int block_side(const Rect& frame, int parts) {
  const std::int64_t area = frame.area() / (kBlocksPerPart * parts);
  int side = 1;
  while (std::int64_t{side + 1} * (side + 1) <= area) ++side;
  if (side >= 16) return side / 16 * 16;
  if (side >= 4) return side / 4 * 4;
  return side;
}

}  // namespace

Partition interlaced(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  if (frame.empty()) return {frame, {}};
  return interlaced_blocks(frame, parts, block_side(frame, parts));
}

}  // namespace delray::loadbalance::internal
