// Counts points on a grid, cuts it, and sends each point to the rank of its tile.
#include "delaunay/tiles/distribute_points.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "comm/collectives.h"
#include "delaunay/tiles/point_records.h"
#include "delaunay/tiles/tile_cut.h"
#include "delaunay/tiles/tile_store.h"
#include "loadbalance/partition.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {

void add_up(comm::Communicator& communicator, CountGrid& grid) {
  if (communicator.size() == 1) return;
  std::array<double, 6> bounds;
  for (int k = 0; k < 3; ++k) {
    bounds[k] = -grid.box().low[k];
    bounds[3 + k] = grid.box().high[k];
  }
  comm::all_reduce(communicator, std::span<double>(bounds),
                   [](double a, double b) { return std::max(a, b); });
  geometry::Box3d box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = -bounds[k];
    box.high[k] = bounds[3 + k];
  }
  grid.cover(box);
  comm::all_reduce(communicator, grid.counts(), std::plus<>());
}

TileCut cut_points(comm::Communicator& communicator, std::span<const RowPoint> points, int dim,
                   int tiles, const loadbalance::Partitioner& partitioner) {
  CountGrid grid(dim, cells_along_axis(dim, static_cast<std::uint64_t>(tiles)));
  geometry::Box3d box;
  for (const RowPoint& point : points) box.include(point.position);
  grid.cover(box);
  for (const RowPoint& point : points) grid.add(point.position);
  add_up(communicator, grid);
  return TileCut(grid.lattice(), grid.counts(), tiles, partitioner);
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
