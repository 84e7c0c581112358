// The tiles of a rank, settled one after the other and put together by what they leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "delaunay/tiles/region.h"
#include "delaunay/tiles/settle.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

// Regions have numbers: a tile its own; what the tiles [a, b) leave together, b - a > 1, the number
// of all tiles plus the number of the first tile of its second half, less one.
constexpr std::size_t region_of(std::size_t all_tiles, std::size_t first, std::size_t last) {
  return last - first == 1 ? first : all_tiles + first + (last - first) / 2 - 1;
}

struct TileWork {
  // The own points of a tile. Any thread, once for each tile, in ascending order but for threads.
  std::function<Region(std::size_t tile)> points;
  // Takes what is final of a region, and may look at what is left. Any thread.
  std::function<void(std::size_t region, Settled& settled)> take;
  // Gives what a region left that was settled in an earlier run, or false. Any thread.
  std::function<bool(std::size_t region, Region& rest)> restore = nullptr;
};

struct SettleOptions {
  Options triangulate;             // of a region; `threads` are those of one worker
  int workers = 1;                 // regions at a time
  std::uint64_t put_together = 0;  // points left by neighbours from which they are put together
  // Throws where so many points are too many to triangulate at once; not asked about tiles.
  std::function<void(std::uint64_t points)> require = nullptr;

  FinalsWish finals = {};  // what `take` needs of what is final

  // The options for what was triangulated before: that makes no progress, but can be interrupted.
  Options again(parallel::Progress& part) const {
    Options options = triangulate;
    if (options.progress != nullptr) options.progress = &part;
    return options;
  }
};

// Settles the tiles [first, last) of all those whose boxes there are, and returns what they leave
// together. Neighbours' rests are put together, down a binary tree of runs of tiles, once they are
// many points; points on one circle or sphere, of which nothing can be given away, only when they
// have doubled. Loops run in the caller's arena.
Region settle_tiles(const OtherTiles& all, const SettleOptions& options, const TileWork& work);

}  // namespace delray::delaunay
