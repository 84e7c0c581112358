// Fills up the ranks that have less than an equal share with the surplus of the others, rank after
// rank, in the order of tiles, so that those which change rank stay close to each other.
//
// A plan that is new every frame has ranks ask for other clusters every frame: it changes only
// where that pays. Degenerate: without seconds every tile stays with its owner.
#include "raytrace/distributed/tile_plan.h"

#include <algorithm>
#include <cstring>

#include "comm/bad_message.h"
#include "comm/collectives.h"

namespace delray::raytrace {
namespace {

// Of an equal share, by which the last frame may be worse than the plan: seconds differ as much
// from one frame to the next.
constexpr double kNoWorse = 0.1;

// Whether the ranks that traced the tiles do about as well as the plan.
bool last_ones_do(std::span<const PlannedTile> tiles, std::span<const std::int32_t> plan,
                  double share, int ranks) {
  std::vector<double> loads(static_cast<std::size_t>(ranks));
  double away = 0.0, away_in_plan = 0.0;  // seconds of tiles that others than their owners trace
  for (const PlannedTile& tile : tiles) {
    if (tile.rank == kNoPlan) return false;
    loads[static_cast<std::size_t>(tile.rank)] += tile.seconds;
    if (tile.rank != tile.owner) away += tile.seconds;
    if (plan[tile.tile] != tile.owner) away_in_plan += tile.seconds;
  }
  return *std::max_element(loads.begin(), loads.end()) <= (1.0 + kNoWorse) * share &&
         away <= away_in_plan + kNoWorse * share;
}

}  // namespace

std::vector<std::int32_t> plan_tiles(std::span<const PlannedTile> tiles, std::uint32_t count,
                                     int ranks, double uneven) {
  std::vector<std::int32_t> plan(count, kNoPlan);
  std::vector<double> loads(static_cast<std::size_t>(ranks));
  double sum = 0.0;
  for (const PlannedTile& tile : tiles) {
    loads[static_cast<std::size_t>(tile.owner)] += tile.seconds;
    sum += tile.seconds;
  }
  const double share = sum / ranks;
  if (*std::max_element(loads.begin(), loads.end()) <= (1.0 + uneven) * share) {
    for (const PlannedTile& tile : tiles) plan[tile.tile] = tile.owner;
    return plan;
  }
  std::vector<double> kept(loads.size());  // by owner, so far
  std::size_t filled = 0;                  // the first rank that may have room
  std::vector<double> room(loads.size());
  for (std::size_t r = 0; r < loads.size(); ++r) room[r] = std::max(0.0, share - loads[r]);
  for (const PlannedTile& tile : tiles) {
    double& mine = kept[static_cast<std::size_t>(tile.owner)];
    // Half of a tile belongs to either side of a border.
    const bool stays = mine + 0.5 * tile.seconds <= share;
    mine += tile.seconds;
    plan[tile.tile] = tile.owner;
    if (stays) continue;
    while (filled < room.size() && room[filled] <= 0.5 * tile.seconds) ++filled;
    if (filled == room.size()) continue;
    room[filled] -= tile.seconds;
    plan[tile.tile] = static_cast<std::int32_t>(filled);
  }
  if (last_ones_do(tiles, plan, share, ranks))
    for (const PlannedTile& tile : tiles) plan[tile.tile] = tile.rank;
  return plan;
}

std::vector<std::int32_t> plan_tiles(comm::Communicator& communicator,
                                     std::span<const PlannedTile> mine, std::uint32_t count,
                                     double uneven) {
  std::vector<PlannedTile> all;
  for (const comm::Buffer& message :
       comm::all_gather(communicator, comm::Buffer::of(std::as_bytes(mine)))) {
    comm::check_message(message.size() % sizeof(PlannedTile) == 0);
    const std::size_t first = all.size();
    all.resize(first + message.size() / sizeof(PlannedTile));
    if (!message.empty()) std::memcpy(&all[first], message.data(), message.size());
  }
  for (const PlannedTile& tile : all) {
    comm::check_message(tile.tile < count && tile.owner >= 0 && tile.owner < communicator.size() &&
                        tile.rank >= 0 && tile.rank < communicator.size());
  }
  if (all.empty()) return {};
  std::sort(all.begin(), all.end(),
            [](const PlannedTile& a, const PlannedTile& b) { return a.tile < b.tile; });
  return plan_tiles(all, count, communicator.size(), uneven);
}

}  // namespace delray::raytrace
