// The tiles that ranks have traced, brought together on rank 0.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "raytrace/internal/sample_tile.h"

namespace delray::raytrace {

// What a tile took, whoever traced it.
struct TileCost {
  std::uint32_t tile = 0;
  std::uint32_t unused = 0;
  std::uint64_t rays = 0;
  double seconds = 0;
};

// Collective: all tiles go into `image` on rank 0, which has the size of the frame there; the
// result is what each of them took, on rank 0, and nothing elsewhere. A rank's tiles are one
// message.
std::vector<TileCost> collect_tiles(comm::Communicator& communicator,
                                    const loadbalance::Blocks& tiles,
                                    std::span<const TilePixels> mine, image::ImageF& image);

// Collective: every rank's statistics on rank 0, by rank; nothing elsewhere.
std::vector<RankStatistics> gather_statistics(comm::Communicator& communicator,
                                              const RankStatistics& mine);

}  // namespace delray::raytrace
