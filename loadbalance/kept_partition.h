// Regions that stay as they are from frame to frame, so that primitives need not change rank.
#pragma once

#include <cstdint>

#include "comm/communicator.h"
#include "loadbalance/partition.h"

namespace delray::loadbalance {

// Keeps its partition for as long as nobody would have to do more than `factor` times an equal
// share of the frame's work (as sort-first systems over animations do; Mueller 1995). One per
// rank.
class KeptPartition {
 public:
  // With a factor of 1 it is cut anew for every frame that is not perfectly balanced.
  // REQUIRES: ranks, regions_per_rank >= 1; factor >= 1.
  KeptPartition(const Partitioner& partitioner, int ranks, double factor, int regions_per_rank = 1);

  // The partition for a frame with these costs: the last one, or a new one where the last would not
  // do or was for another frame. The reference stays valid until the next call. O(loads) when kept.
  const Partition& next(const Costs& costs);
  // As above, for all ranks together: rank 0, whose costs alone count, decides and cuts, and tells
  // the others. Collective: a broadcast of the regions, kept or not.
  const Partition& next(const Costs& costs, comm::Communicator& communicator);

  // The last partition once more, for a frame with the costs of the last one. REQUIRES: there was
  // one.
  const Partition& again() {
    ++frames_;
    return partition_;
  }

  // The partition that next returned last: to scale costs by the times it took. Without regions
  // before that.
  const Partition& last() const { return partition_; }
  std::uint64_t frames() const { return frames_; }
  std::uint64_t recomputed() const { return recomputed_; }

 private:
  bool may_keep(const Costs& costs) const;
  Partition cut(const Costs& costs) const;

  const Partitioner* partitioner_;
  int ranks_;
  double factor_;
  int regions_per_rank_;
  Partition partition_;
  std::uint64_t frames_ = 0, recomputed_ = 0;
};

}  // namespace delray::loadbalance
