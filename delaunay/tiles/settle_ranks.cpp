// Settles a rank's tiles, then exchanges what other ranks must know of the rest until nobody has
// anything to tell: after the extreme points, one exchange is enough as a rule.
#include "delaunay/tiles/settle_ranks.h"

#include <functional>
#include <mutex>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/tiles/rank_region.h"
#include "delaunay/tiles/tile_cut.h"

namespace delray::delaunay {
namespace {

std::vector<comm::Parcel> pack(const std::vector<RankMessage>& messages) {
  std::vector<comm::Parcel> parcels;
  for (std::size_t first = 0, last = 0; first < messages.size(); first = last) {
    while (last < messages.size() && messages[last].rank == messages[first].rank) ++last;
    comm::Buffer buffer((last - first) * sizeof(RowPoint));
    const auto points = buffer.as<RowPoint>();
    for (std::size_t i = first; i < last; ++i) points[i - first] = messages[i].point;
    parcels.push_back({messages[first].rank, std::move(buffer)});
  }
  return parcels;
}

void count(const Settled& settled, int dim, TileStatistics& statistics) {
  statistics.simplices += settled.simplices;
  statistics.own_simplices += settled.finals.simplices.size() / (static_cast<std::size_t>(dim) + 1);
}

}  // namespace

std::vector<TileSummary> share_summaries(comm::Communicator& communicator,
                                         std::span<const TileSummary> mine) {
  std::vector<TileSummary> all;
  for (const comm::Buffer& each : comm::all_gather(communicator, comm::Buffer::of(mine))) {
    const auto received = each.as<TileSummary>();
    all.insert(all.end(), received.begin(), received.end());
  }
  return all;
}

RankTotals settle_ranks(comm::Communicator& communicator, std::span<const TileSummary> summaries,
                        const SettleOptions& options, const TileWork& work) {
  const int tiles = static_cast<int>(summaries.size()), ranks = communicator.size();
  const int dim = options.triangulate.dim;
  const auto first = static_cast<std::size_t>(first_tile(communicator.rank(), ranks, tiles));
  const auto last = static_cast<std::size_t>(first_tile(communicator.rank() + 1, ranks, tiles));
  const TileBoxes boxes(summaries);
  const OtherTiles others{boxes, first, last};

  RankTotals totals;
  totals.tiles.resize(last - first);
  std::mutex mutex;
  TileWork counted = work;
  counted.take = [&](std::size_t region, Settled& settled) {
    work.take(region, settled);
    const std::lock_guard lock(mutex);
    const bool is_tile = region < summaries.size();
    count(settled, dim, is_tile ? totals.tiles[region - first] : totals.shared);
    if (is_tile) totals.distinct += settled.distinct;
    totals.hull_facets += settled.finals.hull_facets;
  };
  counted.points = [&](std::size_t tile) {
    Region region = work.points(tile);
    const std::lock_guard lock(mutex);
    totals.tiles[tile - first].points = region.own;
    return region;
  };

  // A single tile learns of others' extreme points before it is triangulated.
  const bool is_single = last - first == 1 && ranks > 1;
  Region rest = comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (first == last) return Region();
    return is_single ? counted.points(first) : settle_tiles(others, options, counted);
  });
  TileStatistics& statistics = is_single ? totals.tiles.front() : totals.shared;
  const std::size_t root =
      is_single ? first : summaries.size() + first + (last - first) / 2 - (first < last ? 1 : 0);
  Options triangulate = options.triangulate;
  triangulate.threads *= options.workers;
  if (!is_single) triangulate.progress = nullptr;
  RankRegion region(std::move(rest), others, triangulate, [&](std::size_t tile) {
    return rank_of_tile(static_cast<int>(tile), ranks, tiles);
  });
  for (std::size_t tile = 0; tile < summaries.size(); ++tile) {
    if (!others.has(tile)) continue;
    region.add_halo({summaries[tile].extremes, summaries[tile].extreme_count});
  }
  const auto take = [&](Settled& settled) {
    count(settled, dim, statistics);
    totals.hull_facets += settled.finals.hull_facets;
    if (settled.finals.simplices.size() > 0) work.take(root, settled);
  };
  for (;; ++totals.rounds) {
    const auto messages = comm::all_or_none(communicator, comm::Phase::other, [&] {
      Settled settled;
      auto found = region.look(settled);
      if (is_single && totals.rounds == 0 && settled.distinct > 0) {
        totals.distinct += settled.distinct - region.halo();
      }
      take(settled);
      return found;
    });
    statistics.sent += messages.size();
    const auto told =
        comm::all_reduce_value(communicator, std::uint64_t{messages.size()}, std::plus<>());
    if (told == 0) break;
    for (const comm::Parcel& parcel : comm::exchange(communicator, pack(messages))) {
      region.add_halo(parcel.message.as<RowPoint>());
    }
  }
  statistics.halo = region.halo();
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    Settled settled = region.finish();
    take(settled);
  });
  return totals;
}

}  // namespace delray::delaunay
