// Owners of a row of blocks follow each other, and go on in the next one after a shift.
#include "loadbalance/partitions/interlaced_blocks.h"

#include <cstdint>
#include <numeric>

namespace delray::loadbalance::internal {
namespace {

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

Partition interlaced_blocks(geometry::Rect frame, int parts, int side) {
  Partition partition{frame, {}};
  const int shift = shift_of(parts);
  std::int64_t row_owner = 0;
  for (int y = frame.y0; y < frame.y1; y += side) {
    std::int64_t owner = row_owner;
    for (int x = frame.x0; x < frame.x1; x += side) {
      const geometry::Rect block{x, y, x + side, y + side};
      partition.regions.push_back({geometry::intersection(block, frame), static_cast<int>(owner)});
      owner = (owner + 1) % parts;
    }
    row_owner = (row_owner + shift) % parts;
  }
  return partition;
}

}  // namespace delray::loadbalance::internal
