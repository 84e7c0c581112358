// The areas of ranks, and the points that lie in them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/distributed.h"
#include "delaunay/tiles/tile_cut.h"

namespace delray::delaunay {

// Each point of an area once: of equal ones, which lie in one area, that with the lowest row.
// Ascending in lexicographic order, by the first `dim` coordinates.
std::vector<RowPoint> distinct_points(std::vector<RowPoint> points, int dim);

// Space cut into as many areas as there are ranks with points: all, or all but rank 0.
class Areas {
 public:
  // Collective. `spared` ranks, the first ones, have no area. REQUIRES: spared < ranks.
  Areas(comm::Communicator& communicator, std::span<const RowPoint> points,
        const DistributedOptions& options, int spared = 0);

  // The rank whose area has the point, which may be none of the first ones.
  int rank_of(const glm::dvec3& position) const { return spared_ + cut_.tile_of(position); }

  // Collective: the distinct points of this rank's area, of those that all ranks give.
  std::vector<RowPoint> own_points(comm::Communicator& communicator,
                                   std::span<const RowPoint> points, int dim) const;

 private:
  int spared_;
  TileCut cut_;
};

// Collective: sends points[i] to rank ranks[i]; returns those that came, in the order of their
// senders. REQUIRES: as many ranks as points.
std::vector<RowPoint> send_points(comm::Communicator& communicator,
                                  std::span<const RowPoint> points, std::span<const int> ranks);

}  // namespace delray::delaunay
