// Triangulations that ranks make together by one of the distributed methods.
#pragma once

#include <vector>

#include "apps/statistics.h"
#include "apps/triangulate_tiles.h"
#include "comm/communicator.h"
#include "delaunay/distributed.h"
#include "delaunay/points.h"

namespace delray::apps {

// What all ranks have made together, and what each of them took for it. Of rank 0.
struct DistributedRun {
  TiledRun made;
  std::vector<delaunay::DistributedStatistics> ranks;
};

// Collective: brings what ranks have made together on rank 0.
DistributedRun gather_run(comm::Communicator& communicator,
                          const delaunay::DistributedTriangulation& mine, bool with_vertices);

// Collective: triangulates the points, which every rank has, each rank beginning with a run of
// their rows. Throws what triangulate_distributed() throws.
DistributedRun triangulate_by_method(comm::Communicator& communicator,
                                     const delaunay::PointCloud& points,
                                     const delaunay::DistributedOptions& options,
                                     bool with_vertices);

// Sums over ranks, and each rank's.
Json distributed_json(const delaunay::DistributedOptions& options, const DistributedRun& run);

// The sum over ranks, of seconds too.
delaunay::DistributedStatistics sum_of(const std::vector<delaunay::DistributedStatistics>& ranks);
// For all statistics of that kind.
Json counts_json(const delaunay::DistributedStatistics& counts);

}  // namespace delray::apps
