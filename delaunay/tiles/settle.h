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
  std::uint64_t points = 0;           // of a tile, equal ones included; else 0
  std::uint64_t distinct = 0;         // of a tile's points; else 0
  std::uint64_t simplices = 0;        // that it took
  bool is_last = false;               // of what is left in the end, which no journal has
};

// Triangulates the region and gives away what others cannot change: all of it where there are no
// others. Errors: see triangulate().
struct SettleWish {
  bool is_tile = false;   // nobody has triangulated its points yet
  bool messages = false;  // are wanted
  FinalsWish finals = {};
};
Settled settle(Region&& region, const OtherTiles& others, const Options& options,
               const SettleWish& wish);

}  // namespace delray::delaunay
