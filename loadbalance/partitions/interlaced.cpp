// Square blocks assigned to owners in turn, each row shifted by a number that is prime to the
// number of owners and near its golden section, so that an owner's blocks lie apart in rows and in
// columns. O(blocks). Degenerate: a frame with fewer pixels than blocks are wanted has blocks of
// one pixel.
#include <algorithm>
#include <cstdint>
#include <numeric>

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

// The shift of owners from one row of blocks to the next: prime to their number, so that columns
// meet all of them, and near the golden section of it, so that those of an owner lie apart.
int shift_of(int parts) {
  const int wanted = static_cast<int>((std::int64_t{parts} * 382 + 500) / 1000);
  for (int distance = 0; distance < parts; ++distance) {
    for (const int shift : {wanted - distance, wanted + distance}) {
      if (shift >= 1 && std::gcd(shift, parts) == 1) return shift;
    }
  }
  return 1;
}

}  // namespace

Partition interlaced(const Costs& costs, Rect frame, int parts) {
  check_costs(costs, frame, parts);
  Partition partition{frame, {}};
  if (frame.empty()) return partition;
  const int side = block_side(frame, parts), shift = shift_of(parts);
  std::int64_t row_owner = 0;
  for (int y = frame.y0; y < frame.y1; y += side) {
    std::int64_t owner = row_owner;
    for (int x = frame.x0; x < frame.x1; x += side) {
      const Rect block{x, y, x + side, y + side};
      partition.regions.push_back({geometry::intersection(block, frame), static_cast<int>(owner)});
      owner = (owner + 1) % parts;
    }
    row_owner = (row_owner + shift) % parts;
  }
  return partition;
}

}  // namespace delray::loadbalance::internal
