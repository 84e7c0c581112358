// From a partition of the frame to tasks.
#pragma once

#include <vector>

#include "loadbalance/partition.h"
#include "loadbalance/task_grid.h"

namespace delray::loadbalance {

// The blocks whose middle lies in one of an owner's regions, ascending: what a rank begins with
// where blocks change rank later (ScheduleOptions::initial). Over all owners every block comes
// once. O(regions + blocks). REQUIRES: partition.frame == blocks.frame.
std::vector<TaskRange> owned_blocks(const Partition& partition, const Blocks& blocks, int owner);

}  // namespace delray::loadbalance
