// Tiles of all ranks, settled up to the last simplex.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/settle_tiles.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

// What it took to tell other ranks of points.
struct Exchanges {
  std::uint64_t halo = 0;  // points of others that this rank was told of
  std::uint64_t sent = 0;  // its own that it told others of, once for each
  int rounds = 0;
  bool of_tile = false;  // whether the rank has one tile, which these are counts of
};

// Collective: the summaries of all tiles, given those of this rank's.
std::vector<TileSummary> share_summaries(comm::Communicator& communicator,
                                         std::span<const TileSummary> mine);

// Collective: every simplex of the triangulation of all ranks' points goes to one rank's
// `work.take`. What several ranks share is not restored. Errors that a rank meets are thrown on
// all.
Exchanges settle_ranks(comm::Communicator& communicator, std::span<const TileSummary> summaries,
                       const SettleOptions& options, const TileWork& work);

}  // namespace delray::delaunay
