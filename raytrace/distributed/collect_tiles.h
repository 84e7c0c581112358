// The tiles that ranks have traced, brought together on rank 0.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/partition.h"
#include "raytrace/integrators/sample_tile.h"

namespace delray::raytrace {

// Collective: all tiles go into `image` on rank 0, where that has the size of the tiles' frame and
// has rank 0's own tiles already; the result is what each of them took, on rank 0, and nothing
// elsewhere. A rank's tiles are one message.
std::vector<TileCost> collect_tiles(comm::Communicator& communicator,
                                    const loadbalance::Blocks& tiles,
                                    std::span<const TilePixels> mine, image::ImageF& image);

// Throws std::invalid_argument for a display that is empty, reaches beyond the window, or is no
// rank's.
void check_displays(std::span<const loadbalance::Region> displays, const geometry::Rect& window,
                    int ranks);

// Collective: the pictures of the displays that this rank owns, in their order, of everybody's
// tiles.
std::vector<image::ImageF> deliver_tiles(comm::Communicator& communicator,
                                         std::span<const TilePixels> mine,
                                         std::span<const loadbalance::Region> displays);

// Collective: what each tile took, on rank 0; nothing elsewhere.
std::vector<TileCost> collect_costs(comm::Communicator& communicator,
                                    std::span<const TilePixels> mine);

// Collective: every rank's statistics on rank 0, by rank; nothing elsewhere.
std::vector<RankStatistics> gather_statistics(comm::Communicator& communicator,
                                              const RankStatistics& mine);

}  // namespace delray::raytrace
