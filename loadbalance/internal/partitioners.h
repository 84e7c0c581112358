// The functions behind the table of partitions, one file each.
#pragma once

#include "loadbalance/partition.h"

namespace delray::loadbalance::internal {

// Mesh-based adaptive hierarchical decomposition (Mueller 1995): the frame is cut in two again and
// again, at the column or row of the cost grid where the summed-area table comes nearest to the
// share of the cost that goes with the share of the parts.
//
// The longer side (in pixels) is cut, by a vertical line where both are equal; of an odd number of
// parts the first side gets the larger half at even depths of the recursion and the smaller at odd
// ones; of two cuts that are equally near the first is taken. Where there is no cost at all the
// cut goes by area. At most one region per owner; cuts fall on cell borders, so with more parts
// than cells some owners have none. O(cells + parts log cells).
//
// REQUIRES: every cost is finite and >= 0.
Partition mahd(const Costs& costs, geometry::Rect frame, int parts);

// Square blocks, at least 16 per part where there are pixels enough, dealt out in two dimensions:
// the owners follow each other in a row of blocks and are shifted from row to row, so that every
// row and every column of blocks meets all owners in turn. Costs do not matter. O(blocks).
Partition interlaced(const Costs& costs, geometry::Rect frame, int parts);

}  // namespace delray::loadbalance::internal
