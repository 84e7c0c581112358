// Triangulations that ranks make together, tile by tile.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/statistics.h"
#include "comm/communicator.h"
#include "delaunay/points.h"
#include "delaunay/tiles.h"

namespace delray::apps {

// What all ranks have made together.
struct TiledRun {
  // With its vertices where they were asked for, and with its counts.
  delaunay::Triangulation triangulation;
  std::uint64_t simplices = 0;
  delaunay::Hash128 hash;
  std::vector<delaunay::TileStatistics> tiles;
  int rounds = 0;
};

// The points of this rank: a run of their rows.
std::vector<delaunay::RowPoint> own_rows(const comm::Communicator& communicator,
                                         const delaunay::PointCloud& points);

// Collective: brings what ranks have made together on rank 0.
TiledRun gather_parts(comm::Communicator& communicator, const delaunay::TiledTriangulation& part,
                      bool with_vertices);

// Collective: triangulates the points, which every rank has, each rank beginning with a run of
// their rows. The result is rank 0's. Throws what triangulate_tiles() throws.
TiledRun triangulate_by_ranks(comm::Communicator& communicator, const delaunay::PointCloud& points,
                              const delaunay::TileOptions& options, bool with_vertices);

Json tiles_json(const TiledRun& run);

}  // namespace delray::apps
