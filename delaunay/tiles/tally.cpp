// Sums over regions.
#include "delaunay/tiles/tally.h"

namespace delray::delaunay {
RegionCount count_of(std::uint64_t region, const Settled& settled) {
  RegionCount count;
  count.region = region;
  count.points = settled.points;
  count.distinct = settled.distinct;
  count.simplices = settled.simplices;
  count.own_simplices = settled.finals.count;
  count.hull_facets = settled.finals.hull_facets;
  count.hash = settled.finals.hash;
  return count;
}

void Tally::add(const RegionCount& count) {
  const std::lock_guard lock(mutex_);
  TileStatistics& statistics = count.region < all_ ? tiles[count.region - first_] : shared;
  statistics.points += count.points;
  statistics.simplices += count.simplices;
  statistics.own_simplices += count.own_simplices;
  points += count.points;
  distinct += count.distinct;
  simplices += count.own_simplices;
  hull_facets += count.hull_facets;
  hash = hash + count.hash;
}

}  // namespace delray::delaunay
