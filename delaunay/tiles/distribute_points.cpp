// Counts points on a grid, cuts it, and sends each point to the rank of its tile.
#include "delaunay/tiles/distribute_points.h"

#include <algorithm>
#include <array>
#include <utility>

#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kHead = 2 * sizeof(std::uint64_t);  // of a tile: its number, how many points

std::size_t bytes_of(std::uint64_t points) {
  return points == 0 ? 0 : kHead + points * sizeof(RowPoint);
}

}  // namespace

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

std::vector<comm::Parcel> pack_by_tile(std::span<const RowPoint> points, const TileCut& cut,
                                       int tiles, int ranks) {
  std::vector<std::int32_t> tile_of(points.size());
  constexpr std::size_t kGrain = 16384;  // points: some tenths of a millisecond
  parallel::parallel_for(0, points.size(), kGrain,
                         [&](std::size_t i) { tile_of[i] = cut.tile_of(points[i].position); });
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(tiles));
  for (const std::int32_t tile : tile_of) ++counts[static_cast<std::size_t>(tile)];

  std::vector<comm::Parcel> parcels;
  std::vector<std::byte*> next(counts.size());
  for (int rank = 0; rank < ranks; ++rank) {
    const auto first = static_cast<std::size_t>(first_tile(rank, ranks, tiles));
    const auto last = static_cast<std::size_t>(first_tile(rank + 1, ranks, tiles));
    std::size_t bytes = 0;
    for (std::size_t tile = first; tile < last; ++tile) bytes += bytes_of(counts[tile]);
    if (bytes == 0) continue;
    parcels.push_back({rank, comm::Buffer(bytes)});
    std::byte* at = parcels.back().message.data();
    for (std::size_t tile = first; tile < last; ++tile) {
      if (counts[tile] == 0) continue;
      const std::uint64_t head[2] = {tile, counts[tile]};
      std::memcpy(at, head, kHead);
      next[tile] = at + kHead;
      at += bytes_of(counts[tile]);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::byte*& to = next[static_cast<std::size_t>(tile_of[i])];
    std::memcpy(to, &points[i], sizeof points[i]);
    to += sizeof points[i];
  }
  return parcels;
}

void unpack_tiles(const comm::Buffer& message,
                  const std::function<void(std::size_t, std::span<const RowPoint>)>& take) {
  for (std::size_t at = 0; at < message.size();) {
    std::uint64_t head[2];
    std::memcpy(head, message.data() + at, kHead);
    const auto* points = reinterpret_cast<const RowPoint*>(message.data() + at + kHead);
    take(head[0], std::span(points, head[1]));
    at += bytes_of(head[1]);
  }
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
    CountGrid grid(dim, cells_along_axis(dim, static_cast<std::uint64_t>(tiles)));
    geometry::Box3d box;
    for (const RowPoint& point : points) box.include(point.position);
    grid.cover(box);
    for (const RowPoint& point : points) grid.add(point.position);
    add_up(communicator, grid);
    const TileCut cut(grid.lattice(), grid.counts(), tiles,
                      *loadbalance::find_partitioner(options.partition));
    const auto received = comm::exchange(communicator, pack_by_tile(points, cut, tiles, ranks));
    std::vector<std::size_t> sizes(own.size());
    for (const bool copy : {false, true}) {
      for (std::size_t i = 0; copy && i < own.size(); ++i) own[i].reserve(sizes[i]);
      for (const comm::Parcel& parcel : received) {
        unpack_tiles(parcel.message, [&](std::size_t tile, std::span<const RowPoint> some) {
          auto& all = own[tile - first];
          sizes[tile - first] += some.size();
          if (copy) all.insert(all.end(), some.begin(), some.end());
        });
      }
    }
  }
  for (auto& each : own) {
    if (!std::ranges::is_sorted(each, {}, &RowPoint::row)) {
      std::ranges::sort(each, {}, &RowPoint::row);
    }
  }
  return own;
}

}  // namespace delray::delaunay
