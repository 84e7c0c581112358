// Boxes as partitions share them out: clipped to the frame, with their costs by pixel.
#pragma once

#include <vector>

#include "loadbalance/costs.h"

namespace delray::loadbalance::internal {

// A box cut off at the frame's border, never empty.
struct Item {
  geometry::Rect box;
  double setup = 0;       // paid by everybody who gets some of the box
  double density = 0;     // what else it costs, per pixel of the box
  double primitives = 0;  // how many
};

// The boxes that are in the frame; where there are none, the cells with a cost, each as many
// primitives as it costs.
std::vector<Item> items_of(const Costs& costs);

}  // namespace delray::loadbalance::internal
