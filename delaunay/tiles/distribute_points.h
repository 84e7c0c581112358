// Points on their way to the ranks of their tiles.
#pragma once

#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tiles.h"
#include "delaunay/tiles/tile_cut.h"

namespace delray::delaunay {

// Collective: cuts space into `tiles` of about as many points; returns the points of the rank's own
// tiles, of all ranks, by ascending rows. O(points of the rank + tiles).
std::vector<std::vector<RowPoint>> distribute_points(comm::Communicator& communicator,
                                                     std::span<const RowPoint> points,
                                                     const TileOptions& options, int tiles);

// Collective: cuts space into `tiles` of about as many points. O(points of the rank + tiles), on
// rank 0 cut_places() besides.
TileCut cut_points(comm::Communicator& communicator, std::span<const RowPoint> points, int dim,
                   int tiles, const loadbalance::Partitioner& partitioner);

}  // namespace delray::delaunay
