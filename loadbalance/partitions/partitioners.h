// The functions behind the table of partitions, one file each.
#pragma once

#include "loadbalance/partition.h"

namespace delray::loadbalance::internal {

// Throws std::invalid_argument for what no partition can be cut from. O(cells + boxes).
void check_costs(const Costs& costs, geometry::Rect frame, int parts);

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

// Square blocks, at least 16 per part where there are pixels enough, assigned in two dimensions:
// the owners follow each other in a row of blocks and are shifted from row to row, so that every
// row and every column of blocks meets all owners in turn. Costs do not matter. O(blocks).
Partition interlaced(const Costs& costs, geometry::Rect frame, int parts);

// Square blocks of kPixelPlanesSide pixels (Pixel-Planes 5, Fuchs et al. 1989), the costliest first
// to the part that has least: none has more than an equal share and one block.
// O(cells + boxes + blocks log blocks).
inline constexpr int kPixelPlanesSide = 128;
Partition pixel_planes(const Costs& costs, geometry::Rect frame, int parts);

// Square blocks of kInfiniteRealitySide pixels (InfiniteReality, Montrym et al. 1997), assigned as
// interlaced does. Costs do not matter. O(blocks).
inline constexpr int kInfiniteRealitySide = 16;
Partition infinite_reality(const Costs& costs, geometry::Rect frame, int parts);

// A standard decomposition into `parts` rectangles that is corrected again and again: the region
// that most primitives overlap is split in half, and the two neighbours with the fewest that form a
// rectangle become one (Roble 1988). Ends when they would have as many as the region that is split,
// or after 4 * parts times. The sizes of primitives do not count.
// O(boxes rows + parts (parts log parts + boxes of the largest region)).
Partition roble(const Costs& costs, geometry::Rect frame, int parts);

// Median cut (Whelan 1985): the longer side is cut where the numbers of primitives whose centroids
// lie on either side are as the numbers of parts; cuts lie on pixels. The sizes of primitives do
// not count. O((boxes + pixels along a side) log parts).
Partition whelan(const Costs& costs, geometry::Rect frame, int parts);

// A quadtree over the cost grid, each cell with the number of primitives that overlap it, so that
// large ones count more than once (Whitman 1992). The node with the highest sum is divided until
// there are ten for each part; they are assigned, the highest first, to the part that has least.
// O(boxes + cells + parts log parts).
Partition whitman(const Costs& costs, geometry::Rect frame, int parts);

// The grid as a graph, its cells weighted with their cost and the edges between neighbours with the
// cost that crosses them, cut into parts of equal cost such that little crosses (Kurc, Aykanat and
// Ozguc 1997): halved again and again, see GridBisection. Regions are unions of cells, not
// rectangles, and may be in several pieces. O(cells log parts).
Partition graph(const Costs& costs, geometry::Rect frame, int parts);

// Sweep lines (Samanta et al. 1999): as the line goes over a region, the cost on its left grows by
// that of each box whose left edge it reaches, and the cost on its right falls by that of each box
// whose right edge it leaves; the cut is where the two cross, each over its number of parts. Of a
// box, `setup` counts on both sides while the line is in it, the rest by area; with setup == cost
// these are the curves of the paper. The longer side is cut, the other where that leaves the
// costlier side clearly less. Cuts lie on pixels.
// O((boxes, counted in each region that they overlap, + pixels along a side) log parts).
Partition kd_split(const Costs& costs, geometry::Rect frame, int parts);

}  // namespace delray::loadbalance::internal
