// The balance of a partition: the work of its owners, primitives that fall to several of
// them counted for each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loadbalance/partition.h"

namespace delray::loadbalance {

// Measures of how evenly a partition shares out the costs.
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
// Throws std::invalid_argument for a region of another owner. REQUIRES: costs as for make_costs.
Balance balance(const Partition& partition, std::span<const WeightedBox> boxes, int owners);

// The quality of a partition before anything is rendered. Afterwards imbalance() of the
// ranks' busy times tells what the prediction was worth.
struct PartitionReport {
  Partition partition;
  double predicted = 1;  // imbalance of the loads that the grid gives
  Balance balance;       // of costs.boxes
  double seconds = 0;    // that cutting took, here
};

// Cuts for `ranks` ranks, regions_per_rank regions for each, and looks at the outcome.
// Throws std::invalid_argument unless both are at least 1.
PartitionReport report(const Partitioner& partitioner, const Costs& costs, int ranks,
                       int regions_per_rank = 1);

}  // namespace delray::loadbalance
