// What has come of each region so far.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "delaunay/tiles.h"
#include "delaunay/tiles/settle.h"
#include "delaunay/triangulation.h"

namespace delray::delaunay {

// What a region gave away.
struct RegionCount {
  std::uint64_t region = 0;         // as in settle_tiles.h
  std::uint64_t points = 0;         // of a tile
  std::uint64_t distinct = 0;       // of a tile
  std::uint64_t simplices = 0;      // that its triangulations had
  std::uint64_t own_simplices = 0;  // of which it gave away
  std::uint64_t hull_facets = 0;
  Hash128 hash = {};  // of what it gave away
};

RegionCount count_of(std::uint64_t region, const Settled& settled);

// Sums. Any thread.
class Tally {
 public:
  Tally(std::size_t first_tile, std::size_t own_tiles, std::size_t all_tiles)
      : first_(first_tile), all_(all_tiles), tiles(own_tiles) {}

  void add(const RegionCount& count);

 private:
  std::size_t first_, all_;
  std::mutex mutex_;

 public:
  std::vector<TileStatistics> tiles;
  TileStatistics shared;  // of regions of several tiles
  std::uint64_t points = 0, distinct = 0, simplices = 0, hull_facets = 0;
  Hash128 hash;
};

}  // namespace delray::delaunay
