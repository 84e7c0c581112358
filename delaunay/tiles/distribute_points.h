// Points on their way to the ranks of their tiles.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "comm/collectives.h"
#include "comm/communicator.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/tile_cut.h"

namespace delray::delaunay {

// Collective: cuts the points into `tiles`, each of which has one of all ranks' points that lie in
// it, by ascending rows; returns the rank's own tiles. O(points of the rank + tiles).
std::vector<std::vector<RowPoint>> distribute_points(comm::Communicator& communicator,
                                                     std::span<const RowPoint> points,
                                                     const TileOptions& options, int tiles);

// A message for each rank that some of the points go to, sorted by tiles.
std::vector<comm::Parcel> pack_by_tile(std::span<const RowPoint> points, const TileCut& cut,
                                       int tiles, int ranks);
// Calls take(tile, points) for each tile of a message that pack_by_tile() made.
void unpack_tiles(const comm::Buffer& message,
                  const std::function<void(std::size_t tile, std::span<const RowPoint>)>& take);

// Collective: the common grid of all ranks' boxes, and the counts on it of all of them.
void add_up(comm::Communicator& communicator, CountGrid& grid);

}  // namespace delray::delaunay
