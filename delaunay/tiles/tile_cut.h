// The cut of space into tiles, and who has them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/tiles/count_grid.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {

// Cells along an axis of a grid that leaves so many tiles fine cuts.
int cells_along_axis(int dim, std::uint64_t tiles);

// Cuts a grid of counts by a partition of loadbalance/, the same that cut pictures: tiles are
// unions of its cells. In 3D slabs are cut first, across the axis with the fewest cells, each for a
// run of tiles with as many points as these should have; a partition cuts each slab into columns.
// Tiles with near numbers are near each other if the partition numbers owners so. O(cells).
class TileCut {
 public:
  TileCut() = default;
  // REQUIRES: tiles >= 1.
  TileCut(const CellLattice& lattice, std::span<const std::uint64_t> counts, int tiles,
          const loadbalance::Partitioner& partitioner);

  // Equal points lie in one tile. REQUIRES: `position` is in the box of the lattice.
  int tile_of(const glm::dvec3& position) const { return owner_[lattice_.cell_of(position)]; }
  // The same for a place anywhere: outside of the box, the tile at the border there. REQUIRES: the
  // lattice was made of the box, which is not empty.
  int nearest_tile_of(const glm::dvec3& position) const {
    const geometry::Box3d& box = lattice_.box();
    return tile_of(glm::clamp(position, box.low, box.high));
  }
  // How many points each tile has, by the counts of the same lattice.
  std::vector<std::uint64_t> points_of_tiles(std::span<const std::uint64_t> counts) const;

 private:
  CellLattice lattice_;
  int tiles_ = 1;
  std::vector<std::int32_t> owner_;
};

// Ranks have runs of tiles, as even as can be: rank r those from first_tile(r) to first_tile(r +
// 1).
inline int first_tile(int rank, int ranks, int tiles) {
  return static_cast<int>(std::int64_t{rank} * tiles / ranks);
}
int rank_of_tile(int tile, int ranks, int tiles);

}  // namespace delray::delaunay
