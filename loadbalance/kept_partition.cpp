#include "loadbalance/kept_partition.h"

#include <cassert>

namespace delray::loadbalance {

KeptPartition::KeptPartition(const Partitioner& partitioner, int ranks, double factor,
                             int regions_per_rank)
    : partitioner_(&partitioner),
      ranks_(ranks),
      factor_(factor),
      regions_per_rank_(regions_per_rank) {
  assert(ranks >= 1 && regions_per_rank >= 1 && factor >= 1);
}

const Partition& KeptPartition::next(const Costs& costs) {
  const bool keep = frames_ > 0 && partition_.frame == costs.frame &&
                    imbalance(loads(costs, partition_, ranks_)) <= factor_;
  ++frames_;
  if (!keep) {
    partition_ = partition_for_ranks(*partitioner_, costs, ranks_, regions_per_rank_);
    ++recomputed_;
  }
  return partition_;
}

}  // namespace delray::loadbalance
