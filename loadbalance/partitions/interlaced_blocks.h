// Blocks assigned to owners in turn: what interlaced partitions have in common.
#pragma once

#include "loadbalance/partition.h"

namespace delray::loadbalance::internal {

// Square blocks of such a side, assigned in turn, each row shifted by a number that is prime to the
// number of owners and near its golden section, so that an owner's blocks lie apart in rows and in
// columns. O(blocks). REQUIRES: side, parts >= 1.
Partition interlaced_blocks(geometry::Rect frame, int parts, int side);

}  // namespace delray::loadbalance::internal
