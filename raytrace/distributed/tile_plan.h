// Which rank traces which tile, so that ranks that have what most of the picture shows need not
// trace all of that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.h"

namespace delray::raytrace {

inline constexpr std::int32_t kNoPlan = -1;

// A tile of the last frame: whose clusters it shows, the seconds that it took, and who traced it,
// kNoPlan where nobody remembers.
struct PlannedTile {
  std::uint32_t tile = 0;
  std::int32_t owner = 0;
  double seconds = 0.0;
  std::int32_t rank = kNoPlan;
};

// Ranks keep tiles that show their own clusters, but for those beyond an equal share of all
// seconds: the last ones of each such rank go to ranks that have less. Where shares of the last
// frame were about equal, and no more tiles were away from their owners than need be, all stay
// where they were: what they need is there. All tiles stay with their owners where none of these
// has more than 1 + `uneven` equal shares. Element i: the rank of tile i of `count`, kNoPlan where
// no tile is known. O(tiles + ranks).
//
// REQUIRES: tiles are by ascending number; uneven >= 0.
std::vector<std::int32_t> plan_tiles(std::span<const PlannedTile> tiles, std::uint32_t count,
                                     int ranks, double uneven = 0.0);

// Collective: the same from what each rank has traced; nothing where no rank knows any.
std::vector<std::int32_t> plan_tiles(comm::Communicator& communicator,
                                     std::span<const PlannedTile> mine, std::uint32_t count,
                                     double uneven);

}  // namespace delray::raytrace
