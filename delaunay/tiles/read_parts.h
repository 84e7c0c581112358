// The two passes over parts of points: one counts them, one gives each to its tile.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/point_parts.h"
#include "delaunay/tiles/memory_plan.h"
#include "delaunay/tiles/point_records.h"
#include "delaunay/tiles/point_sample.h"
#include "delaunay/tiles/tile_boxes.h"
#include "delaunay/tiles/tile_cut.h"
#include "delaunay/tiles/tile_store.h"
#include "delaunay/triangulate_parts.h"
#include "parallel/progress.h"

namespace delray::delaunay {

// What the first pass finds, of all ranks.
struct PartCounts {
  PointSample sample;  // of the rank's points
  std::uint64_t points = 0;
  bool has_z = false;
  geometry::Box3d box;  // of all ranks' points
  // Of the rank's parts, of which the first is first_part: the row of the first point of each, and
  // one more.
  std::size_t first_part = 0;
  std::vector<std::uint64_t> first_rows;
  PointAttributes attributes = {};
};

// Collective: counts the points of all parts, of which each rank reads a run. Threads are those of
// the arena. Errors: std::invalid_argument that names the first row with a coordinate that is not
// finite; those of reading.
struct CountOptions {
  int dim = 2;
  std::uint64_t sample = 1;  // points of all ranks' sample, at most
  std::uint64_t first_row = 0;
};
PartCounts count_parts(comm::Communicator& communicator, const PointParts& parts,
                       const CountOptions& options, parallel::Progress* progress);

// Where points go.
struct Destination {
  const TileCut& cut;
  int dim = 2;
  int tiles = 1;
  RecordFormat format;
  TileStore& store;               // of the rank's own tiles
  std::vector<TileSummary>& own;  // of these, which grow
  std::vector<std::uint64_t>& own_points;
};

// Collective: reads the parts again and stores each point with the rank of its tile. A thread has
// some batch_rows points at a time.
void distribute_parts(comm::Communicator& communicator, const PointParts& parts,
                      const PartCounts& counts, const Destination& to, const MemoryPlan& plan,
                      parallel::Progress* progress);

}  // namespace delray::delaunay
