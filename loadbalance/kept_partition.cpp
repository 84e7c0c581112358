// Keeps or replaces the partition by the predicted imbalance. Rank 0 decides and broadcasts the
// regions of every frame, since the other ranks may not have taken part in the last one.
#include "loadbalance/kept_partition.h"

#include <span>
#include <stdexcept>
#include <utility>

#include "comm/collectives.h"

namespace delray::loadbalance {

KeptPartition::KeptPartition(const Partitioner& partitioner, int ranks, double factor,
                             int regions_per_rank)
    : partitioner_(&partitioner),
      ranks_(ranks),
      factor_(factor),
      regions_per_rank_(regions_per_rank) {
  if (ranks < 1 || regions_per_rank < 1 || !(factor >= 1)) {
    throw std::invalid_argument(
        "there is at least one rank with a region, and at least an equal share to keep");
  }
}

bool KeptPartition::may_keep(const Costs& costs) const {
  return frames_ > 0 && partition_.frame == costs.frame &&
         imbalance(loads(costs, partition_, ranks_)) <= factor_;
}

Partition KeptPartition::cut(const Costs& costs) const {
  return partition_for_ranks(*partitioner_, costs, ranks_, regions_per_rank_);
}

const Partition& KeptPartition::next(const Costs& costs) {
  if (!may_keep(costs)) {
    partition_ = cut(costs);
    ++recomputed_;
  }
  ++frames_;
  return partition_;
}

// Rank 0 tells the others all of it, kept or not: they may be others than in the last frame.
const Partition& KeptPartition::next(const Costs& costs, comm::Communicator& communicator) {
  comm::Buffer news;
  if (communicator.rank() == 0) {
    const std::uint64_t before = recomputed_;
    next(costs);
    const int is_new = recomputed_ > before ? 1 : 0;
    std::vector<Region> regions = {{partition_.frame, is_new}};
    regions.insert(regions.end(), partition_.regions.begin(), partition_.regions.end());
    news = comm::Buffer::of(std::span<const Region>(regions));
  }
  news = comm::broadcast(communicator, 0, std::move(news));
  if (communicator.rank() == 0) return partition_;
  const auto regions = news.as<Region>();
  ++frames_;
  if (regions[0].owner == 1) ++recomputed_;
  partition_ = {regions[0].rect, {regions.begin() + 1, regions.end()}};
  return partition_;
}

}  // namespace delray::loadbalance
