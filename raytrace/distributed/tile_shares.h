// Which tiles a rank begins with, by what they cost in the last frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/kept_partition.h"
#include "raytrace/distributed/collect_tiles.h"

namespace delray::raytrace {

// One per rank; rank 0 alone knows costs.
class TileShares {
 public:
  // This rank's share, of a partition of the frame by options.partition into regions of equal cost:
  // what `learn` was told last, or as much as tiles have pixels when that was of other tiles.
  // Collective.
  std::vector<loadbalance::TaskRange> next(comm::Communicator& communicator,
                                           const loadbalance::Blocks& tiles,
                                           const RenderOptions& options);
  // On rank 0, of every tile of a frame.
  void learn(const loadbalance::Blocks& tiles, std::span<const TileCost> costs, CostSource source);

  // Of the last call of `next`, on rank 0.
  const PartitionStatistics& statistics() const { return statistics_; }

 private:
  loadbalance::Costs costs(const loadbalance::Blocks& tiles, int parts) const;

  // What a partition was cut with; another one does not do for other values.
  struct Kind {
    std::string partition;
    int ranks, regions_per_rank;
    double keep_factor;
    bool operator==(const Kind&) const = default;
  };
  std::optional<Kind> kind_;
  std::optional<loadbalance::KeptPartition> kept_;
  std::vector<loadbalance::WeightedBox> learnt_;  // a tile's each, of this frame:
  geometry::Rect frame_;
  PartitionStatistics statistics_;
};

}  // namespace delray::raytrace
