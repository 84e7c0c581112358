// The cut of space into tiles, and who has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {

// Planes across the axes, each of which cuts what those before it have left of space (Bentley
// 1975). Memory O(tiles).
class TileCut {
 public:
  // A plane: places below it belong to the first of the next ones, all others to the second. A
  // plane that comes after itself ends the search: its axis is 0 and `tile` what was searched for.
  struct Plane {
    double at = 0;
    std::int32_t axis = 0, tile = 0;
    std::uint32_t next[2] = {0, 0};
  };

  // All of space is tile 0.
  TileCut() : TileCut(std::vector<Plane>(1)) {}
  // REQUIRES: plane 0 is the first one; all others come after a plane with a lower number.
  explicit TileCut(std::vector<Plane> planes);

  // Any place. Equal places lie in one tile. So many steps are taken for all, as nobody could
  // foresee the end of fewer.
  int tile_of(const glm::dvec3& position) const {
    const double* const coordinates = &position.x;
    const Plane* plane = planes_.data();
    for (int step = 0; step < depth_; ++step) {
      plane = &planes_[plane->next[coordinates[plane->axis] < plane->at ? 0 : 1]];
    }
    return plane->tile;
  }
  // How many of the places each tile has.
  std::vector<std::uint64_t> count(std::span<const glm::dvec3> places, int tiles) const;

  std::span<const Plane> planes() const { return planes_; }

 private:
  std::vector<Plane> planes_;
  int depth_ = 0;
};

// How many points of a sample leave so many tiles even: at most some 5 % above the mean each.
std::size_t sample_for_tiles(std::uint64_t tiles);

// Cuts space into tiles of about as many of the places, by a partition of loadbalance/, the same
// that cut pictures. Counts of the places on a grid over their box, in 3D seen along its shortest
// axis, are the costs. Of the regions that the partition makes of it only the first straight cut
// that no owner's region crosses is taken, moved to where the places are divided as the owners
// are; both sides are cut likewise by grids of their own, which are finer where points are dense.
// Where there is no such line (owners have regions in several places, or around each other)
// regions are taken as they are. Tiles with near numbers are near each other.
//
// With points_per_place, for how many points a place stands, tiles get even work instead of even
// numbers of points: points along cuts, which are triangulated by more than one tile, count more.
//
// O((places + tiles) log tiles) and some partitions of grids with as many cells as tiles in
// all; O(places log places) with points_per_place. Degenerate: equal places are in one tile, so
// that others may have none.
//
// REQUIRES: tiles >= 1; points_per_place is 0 or at least 1.
TileCut cut_places(std::span<const glm::dvec3> places, int dim, int tiles,
                   const loadbalance::Partitioner& partitioner, double points_per_place = 0);

// For cut_places(), where tiles are those of ranks: in the plane too few points lie along cuts to
// matter.
inline double points_per_place(int dim, std::uint64_t points, std::size_t places) {
  return dim == 2 || places == 0 ? 0 : static_cast<double>(points) / static_cast<double>(places);
}

// Collective: rank 0's cut, for all.
TileCut share_cut(comm::Communicator& communicator, const TileCut& cut);

// Ranks have runs of tiles, as even as can be: rank r those from first_tile(r) to first_tile(r +
// 1).
inline int first_tile(int rank, int ranks, int tiles) {
  return static_cast<int>(std::int64_t{rank} * tiles / ranks);
}
int rank_of_tile(int tile, int ranks, int tiles);

}  // namespace delray::delaunay
