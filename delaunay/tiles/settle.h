// One step of the work on a region: what can change no more is given away.
#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/tiles/region.h"
#include "delaunay/tiles/region_mesh.h"
#include "delaunay/tiles/tile_boxes.h"

namespace delray::delaunay {

struct Settled {
  FinalSimplices finals;
  Region rest;
  std::vector<TileMessage> messages;  // if they were asked for
  std::uint64_t distinct = 0;         // of the region's points, its halo's included
  std::uint64_t simplices = 0;        // that it took
};

// Triangulates the region and gives away what others cannot change: all of it where there are no
// others. Errors: see triangulate().
enum class Messages : std::uint8_t { no, yes };
Settled settle(Region&& region, const OtherTiles& others, const Options& options,
               Messages messages = Messages::no);

}  // namespace delray::delaunay
