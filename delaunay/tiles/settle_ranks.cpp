// Settles a rank's tiles, then exchanges what other ranks must know of the rest until nobody has
// anything to tell: after the extreme points, one exchange is enough as a rule.
#include "delaunay/tiles/settle_ranks.h"

#include <functional>
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

Exchanges settle_ranks(comm::Communicator& communicator, std::span<const TileSummary> summaries,
                       const SettleOptions& options, const TileWork& work) {
  const int tiles = static_cast<int>(summaries.size()), ranks = communicator.size();
  const auto first = static_cast<std::size_t>(first_tile(communicator.rank(), ranks, tiles));
  const auto last = static_cast<std::size_t>(first_tile(communicator.rank() + 1, ranks, tiles));
  const TileBoxes boxes(summaries);
  const OtherTiles others{boxes, first, last};

  // A single tile learns of others' extreme points before it is triangulated.
  Exchanges exchanges;
  exchanges.of_tile = last - first == 1 && ranks > 1;
  Region rest = comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (first == last) return Region();
    return exchanges.of_tile ? work.points(first) : settle_tiles(others, options, work);
  });
  const std::size_t own_region =
      exchanges.of_tile || first == last ? first : region_of(summaries.size(), first, last);
  RankRegion region(
      std::move(rest), others, options,
      {[&](std::size_t tile) { return rank_of_tile(static_cast<int>(tile), ranks, tiles); },
       exchanges.of_tile});
  for (std::size_t tile = 0; tile < summaries.size(); ++tile) {
    if (!others.has(tile)) continue;
    region.add_halo({summaries[tile].extremes, summaries[tile].extreme_count});
  }
  const auto take = [&](Settled& settled) {
    settled.is_last = true;
    work.take(own_region, settled);
  };
  for (;; ++exchanges.rounds) {
    const auto messages = comm::all_or_none(communicator, comm::Phase::other, [&] {
      Settled settled;
      auto found = region.look(settled);
      if (settled.simplices > 0 || settled.points > 0) take(settled);
      return found;
    });
    exchanges.sent += messages.size();
    const auto told =
        comm::all_reduce_value(communicator, std::uint64_t{messages.size()}, std::plus<>());
    if (told == 0) break;
    for (const comm::Parcel& parcel : comm::exchange(communicator, pack(messages))) {
      region.add_halo(parcel.message.as<RowPoint>());
    }
  }
  exchanges.halo = region.halo();
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    Settled settled = region.finish();
    if (settled.finals.count > 0 || settled.finals.hull_facets > 0) {
      take(settled);
    }
  });
  return exchanges;
}

}  // namespace delray::delaunay
