#include "loadbalance/kept_partition.h"

#include <cassert>
#include <span>
#include <utility>

#include "comm/collectives.h"

namespace delray::loadbalance {

KeptPartition::KeptPartition(const Partitioner& partitioner, int ranks, double factor,
                             int regions_per_rank)
    : partitioner_(&partitioner),
      ranks_(ranks),
      factor_(factor),
      regions_per_rank_(regions_per_rank) {
  assert(ranks >= 1 && regions_per_rank >= 1 && factor >= 1);
}

bool KeptPartition::keeps(const Costs& costs) {
  const bool keeps = frames_ > 0 && partition_.frame == costs.frame &&
                     imbalance(loads(costs, partition_, ranks_)) <= factor_;
  ++frames_;
  if (!keeps) ++recomputed_;
  return keeps;
}

Partition KeptPartition::cut(const Costs& costs) const {
  return partition_for_ranks(*partitioner_, costs, ranks_, regions_per_rank_);
}

const Partition& KeptPartition::next(const Costs& costs) {
  if (!keeps(costs)) partition_ = cut(costs);
  return partition_;
}

const Partition& KeptPartition::next(const Costs& costs, comm::Communicator& communicator) {
  if (keeps(costs)) return partition_;
  comm::Buffer regions;
  if (communicator.rank() == 0) {
    partition_ = cut(costs);
    regions = comm::Buffer::of(std::span<const Region>(partition_.regions));
  }
  regions = comm::broadcast(communicator, 0, std::move(regions));
  const auto all = regions.as<Region>();
  partition_ = {costs.frame, {all.begin(), all.end()}};
  return partition_;
}

}  // namespace delray::loadbalance
