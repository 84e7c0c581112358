// Sums over regions, and hashes of simplices by the rows of their points.
#include "delaunay/tiles/tally.h"

#include <array>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Rows of so many simplices are looked up at a time: they stay in the cache.
constexpr std::size_t kHashedAtOnce = 1024;

}  // namespace

Hash128 hash(const FinalSimplices& finals, int dim) {
  const auto corners = static_cast<std::size_t>(dim) + 1;
  const std::size_t simplices = finals.simplices.size() / corners;
  return parallel::parallel_reduce(
      0, simplices, kHashedAtOnce, Hash128{},
      [&](std::size_t first, std::size_t last) {
        std::array<std::uint64_t, 4 * kHashedAtOnce> rows;
        const std::size_t begin = first * corners, end = last * corners;
        for (std::size_t i = begin; i < end; ++i) {
          rows[i - begin] = finals.points[finals.simplices[i]].row;
        }
        return hash(dim, std::span<const std::uint64_t>(rows).first(end - begin));
      },
      [](const Hash128& a, const Hash128& b) { return a + b; });
}

RegionCount count_of(std::uint64_t region, const Settled& settled, int dim) {
  RegionCount count;
  count.region = region;
  count.points = settled.points;
  count.distinct = settled.distinct;
  count.simplices = settled.simplices;
  count.own_simplices = settled.finals.simplices.size() / (static_cast<std::size_t>(dim) + 1);
  count.hull_facets = settled.finals.hull_facets;
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
