// Cuts the frame by what its tiles cost in the last one, and gives each rank the tiles of its
// regions. Degenerate: a first frame, or one of another size, counts pixels as costs; an empty
// frame has no shares.
#include "raytrace/distributed/tile_shares.h"

#include "loadbalance/owned_blocks.h"

namespace delray::raytrace {

using loadbalance::WeightedBox;

std::vector<loadbalance::TaskRange> TileShares::next(comm::Communicator& communicator,
                                                     const loadbalance::Blocks& tiles,
                                                     const RenderOptions& options) {
  if (tiles.frame.empty()) return {};
  Kind kind{options.partition, communicator.size(), options.regions_per_rank, options.keep_factor};
  if (kind != kind_) {
    kept_.emplace(*loadbalance::find_partitioner(options.partition), kind.ranks, kind.keep_factor,
                  kind.regions_per_rank);
    kind_ = std::move(kind);
  }
  const bool cuts_here = communicator.rank() == 0;
  loadbalance::Costs now;
  if (cuts_here) now = costs(tiles, communicator.size() * options.regions_per_rank);
  const std::uint64_t recomputed = kept_->recomputed();
  const loadbalance::Partition& partition = kept_->next(now, communicator);
  if (cuts_here) {
    statistics_.measured = frame_ == tiles.frame && !learnt_.empty();
    statistics_.kept = kept_->recomputed() == recomputed;
    statistics_.predicted =
        loadbalance::imbalance(loadbalance::loads(now, partition, communicator.size()));
  }
  return loadbalance::owned_blocks(partition, tiles, communicator.rank());
}

void TileShares::learn(const loadbalance::Blocks& tiles, std::span<const TileCost> costs,
                       CostSource source) {
  frame_ = tiles.frame;
  learnt_.clear();
  for (const TileCost& tile : costs) {
    learnt_.push_back({tiles.block(tile.tile),
                       source == CostSource::rays ? static_cast<double>(tile.rays) : tile.seconds,
                       0, 1});
  }
}

loadbalance::Costs TileShares::costs(const loadbalance::Blocks& tiles, int parts) const {
  const geometry::Rect& frame = tiles.frame;
  std::vector<WeightedBox> boxes;
  if (frame_ == frame) boxes = learnt_;
  if (boxes.empty()) {
    for (std::uint32_t tile = 0; tile < tiles.grid().count(); ++tile) {
      const geometry::Rect pixels = tiles.block(tile);
      boxes.push_back({pixels, static_cast<double>(pixels.area()), 0, 1});
    }
  }
  const int side = loadbalance::cost_cell_side(frame, parts);
  return loadbalance::make_costs(frame, (frame.width() + side - 1) / side,
                                 (frame.height() + side - 1) / side, boxes);
}

}  // namespace delray::raytrace
