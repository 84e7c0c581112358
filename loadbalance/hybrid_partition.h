// Groups of primitives and the screen shared out together, so that few pixels need compositing.
#pragma once

#include <span>
#include <vector>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

// Whoever owns a box does all of it, beyond its region, too: what it sees there goes to the owners
// of those pixels. Two kinds of boxes have no such owner: those outside the frame, which nobody
// needs to draw, and those too costly for one rank, of which everybody does what lies in its
// region.
inline constexpr int kNobody = -1, kEverybody = -2;

// Prices and limits of the hybrid partition.
struct HybridOptions {
  // The cost of a pixel that another rank than its owner sees, to both.
  double pixel_cost = 0.25;
  // Boxes that cost more than so many equal shares of the cost of all are everybody's: a ground of
  // two triangles would keep one rank busy for longer than others, and send much of the frame.
  double largest_box = 0.1;
};

// Owners of boxes and of the screen, found together.
struct HybridPartition {
  std::vector<int> owners;  // of box i
  Partition regions;        // at most one for each owner
};

// After Samanta et al. 2000. Two lines sweep towards each other over the longer side of the screen:
// the one from the low end assigns the box that ends first to the low half of the ranks, that from
// the high end the box that begins last to the high half, whichever half has less to do, until all
// boxes are assigned. Then the screen is cut where fewest pixels of boxes lie on the wrong side,
// and both halves go on alike with their ranks, boxes and part of the screen. What a half has to do
// is the cost of its boxes, that of everybody's boxes as far as its line has come, and `pixel_cost`
// for each pixel that is another's for certain and each between the lines, once they have passed
// each other. Lines sweep over the shorter side where that leaves much fewer pixels on the wrong
// side of the cut. A pixel costs 1: what a box costs beyond its setup tells how many of its pixels
// it covers.
//
// Deterministic. With more ranks than boxes or pixels some have none. O(boxes + sides of the frame)
// per halving of the ranks.
//
// REQUIRES: ranks >= 1; costs finite, 0 <= setup <= cost; pixel_cost, largest_box >= 0.
HybridPartition hybrid_partition(std::span<const WeightedBox> boxes, geometry::Rect frame,
                                 int ranks, const HybridOptions& options = {});

}  // namespace delray::loadbalance
