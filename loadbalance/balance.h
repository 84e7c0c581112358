// How even a partition is: what its owners would have to do, primitives that fall to several of
// them counted for each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

struct Balance {
  std::vector<double> loads;  // by owner
  double alone = 0;           // what one owner of the whole frame would have to do
  double imbalance = 1;       // largest load over their mean
  // Largest load over alone / owners: at best 1; what duplicated work costs is in it.
  double over_share = 1;
  std::uint64_t primitives = 0;  // in the frame
  std::uint64_t shared = 0;      // of those, in boxes that fall to several owners
  double overlap = 1;            // owners of a primitive's box, on average
};

// Every owner that has some of a box pays its setup, and of the rest of its cost what goes with its
// pixels of the box. O(boxes x regions near each).
// REQUIRES: owners in [0, owners); costs as for make_costs.
Balance balance(const Partition& partition, std::span<const WeightedBox> boxes, int owners);

}  // namespace delray::loadbalance
