// The cut of space into tiles, and who has them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tiles.h"
#include "geometry/box.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {

// Counts points on a grid over the two longest axes of their box and cuts it by a partition of
// loadbalance/, the same that cut pictures: tiles are unions of its cells, columns in 3D.
class TileCut {
 public:
  // Collective. O(points of the rank + tiles).
  TileCut(comm::Communicator& communicator, std::span<const RowPoint> points, int dim, int tiles,
          const loadbalance::Partitioner& partitioner);

  // Equal points lie in one tile. REQUIRES: `position` is in the box of all ranks' points.
  int tile_of(const glm::dvec3& position) const { return owner_[cell_of(position)]; }

 private:
  std::size_t cell_of(const glm::dvec3& position) const;

  geometry::Box3d box_;
  int axes_[2] = {0, 1};
  int side_ = 1;  // cells of the grid along each axis
  std::vector<std::int32_t> owner_;
};

// Ranks have runs of tiles, as even as can be: rank r those from first_tile(r) to first_tile(r +
// 1).
inline int first_tile(int rank, int ranks, int tiles) {
  return static_cast<int>(std::int64_t{rank} * tiles / ranks);
}
int rank_of_tile(int tile, int ranks, int tiles);

}  // namespace delray::delaunay
