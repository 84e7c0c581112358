// Cuts space by a sample of the points, and sends each point to the rank of its tile.
#include "delaunay/tiles/distribute_points.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/tiles/point_records.h"
#include "delaunay/tiles/point_sample.h"
#include "delaunay/tiles/tile_cut.h"
#include "delaunay/tiles/tile_store.h"
#include "loadbalance/partition.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {

TileCut cut_points(comm::Communicator& communicator, std::span<const RowPoint> points, int dim,
                   int tiles, const loadbalance::Partitioner& partitioner) {
  if (tiles == 1) return {};
  PointSample sample(sample_for_tiles(static_cast<std::uint64_t>(tiles)));
  for (const RowPoint& point : points) sample.add(point.row, point.position);
  const std::vector<glm::dvec3> places = std::move(sample).gather(communicator);
  const std::uint64_t all =
      comm::all_reduce_value(communicator, std::uint64_t{points.size()}, std::plus<>());
  const TileCut cut = comm::all_or_none(communicator, comm::Phase::redistribute, [&] {
    if (communicator.rank() != 0) return TileCut();
    return cut_places(places, dim, tiles, partitioner, points_per_place(dim, all, places.size()));
  });
  return share_cut(communicator, cut);
}

std::vector<std::vector<RowPoint>> distribute_points(comm::Communicator& communicator,
                                                     std::span<const RowPoint> points,
                                                     const TileOptions& options, int tiles) {
  const int dim = options.triangulate.dim, ranks = communicator.size();
  const auto first = static_cast<std::size_t>(first_tile(communicator.rank(), ranks, tiles));
  const auto last = static_cast<std::size_t>(first_tile(communicator.rank() + 1, ranks, tiles));
  std::vector<std::vector<RowPoint>> own(last - first);
  if (tiles == 1 && ranks == 1) {
    own.front().assign(points.begin(), points.end());
  } else {
    const TileCut cut = cut_points(communicator, points, dim, tiles,
                                   *loadbalance::find_partitioner(options.partition));
    std::vector<std::int32_t> tile_of(points.size());
    constexpr std::size_t kGrain = 16384;  // points: some tenths of a millisecond
    parallel::parallel_for(0, points.size(), kGrain,
                           [&](std::size_t i) { tile_of[i] = cut.tile_of(points[i].position); });
    MemoryStore store({}, first, own.size());
    for (comm::Parcel& parcel :
         comm::exchange(communicator, pack_by_tile(points, tile_of, tiles, ranks))) {
      store.add(std::move(parcel.message));
    }
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = store.read(first + i);
  }
  for (auto& each : own) {
    if (!std::ranges::is_sorted(each, {}, &RowPoint::row)) {
      std::ranges::sort(each, {}, &RowPoint::row);
    }
  }
  return own;
}

}  // namespace delray::delaunay
