// Tiles of all ranks, settled up to the last simplex.
#pragma once

#include <cstdint>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/settle_tiles.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

struct RankTotals {
  std::vector<TileStatistics> tiles;  // of this rank's tiles
  TileStatistics shared;              // of what its tiles leave together
  std::uint64_t distinct = 0, hull_facets = 0;
  int rounds = 0;  // of telling other ranks of points
};

// Collective: the summaries of all tiles, given those of this rank's.
std::vector<TileSummary> share_summaries(comm::Communicator& communicator,
                                         std::span<const TileSummary> mine);

// Collective: every simplex of the triangulation of all ranks' points goes to one rank's
// `work.take`. Regions that several ranks share are not restored. `mine` are the rank's tiles, of
// those that `summaries` tell of. Errors that a rank meets are thrown on all.
RankTotals settle_ranks(comm::Communicator& communicator, std::span<const TileSummary> summaries,
                        const SettleOptions& options, const TileWork& work);

}  // namespace delray::delaunay
