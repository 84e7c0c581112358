// What ranks and readers of points do with a cut; cut_places.cpp makes it.
#include "delaunay/tiles/tile_cut.h"

#include <algorithm>
#include <utility>

#include "comm/collectives.h"

namespace delray::delaunay {

TileCut::TileCut(std::vector<Plane> planes) : planes_(std::move(planes)) {
  std::vector<int> depths(planes_.size());
  for (std::uint32_t i = 0; i < planes_.size(); ++i) {
    for (const std::uint32_t next : planes_[i].next) {
      if (next != i) depths[next] = depths[i] + 1;
    }
  }
  depth_ = *std::ranges::max_element(depths);
}

std::vector<std::uint64_t> TileCut::count(std::span<const glm::dvec3> places, int tiles) const {
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(tiles));
  for (const glm::dvec3& place : places) ++counts[static_cast<std::size_t>(tile_of(place))];
  return counts;
}

std::size_t sample_for_tiles(std::uint64_t tiles) {
  // The number of a tile's points varies by 1 / sqrt(4096) = 1.6 % of the mean; among many tiles
  // the largest has three times that too much.
  constexpr std::uint64_t kPerTile = 4096, kFewest = std::uint64_t{1} << 16,
                          kMost = std::uint64_t{1} << 21;
  return static_cast<std::size_t>(std::clamp(kPerTile * std::min(tiles, kMost), kFewest, kMost));
}

TileCut share_cut(comm::Communicator& communicator, const TileCut& cut) {
  comm::Buffer mine;
  if (communicator.rank() == 0) mine = comm::Buffer::of(cut.planes());
  const comm::Buffer planes = comm::broadcast(communicator, 0, std::move(mine));
  const auto received = planes.as<TileCut::Plane>();
  return TileCut({received.begin(), received.end()});
}

int rank_of_tile(int tile, int ranks, int tiles) {
  int rank = static_cast<int>(std::int64_t{tile} * ranks / tiles);
  while (first_tile(rank + 1, ranks, tiles) <= tile) ++rank;
  while (first_tile(rank, ranks, tiles) > tile) --rank;
  return rank;
}

}  // namespace delray::delaunay
