// Areas are the tiles of delaunay/tiles/tile_cut.h: grids of counts (the report's bucketing) that a
// partition of loadbalance/ cuts (its Mueller's algorithm is `mahd`).
#include "delaunay/distributed/areas.h"

#include <algorithm>
#include <cstring>

#include "comm/collectives.h"
#include "delaunay/tiles/distribute_points.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {

std::vector<RowPoint> distinct_points(std::vector<RowPoint> points, int dim) {
  const auto order = [dim](const RowPoint& a, const RowPoint& b) {
    for (int k = 0; k < dim; ++k) {
      if (a.position[k] != b.position[k]) return a.position[k] < b.position[k] ? -1 : 1;
    }
    return 0;
  };
  std::ranges::sort(points, [&](const RowPoint& a, const RowPoint& b) {
    const int sign = order(a, b);
    return sign != 0 ? sign < 0 : a.row < b.row;
  });
  const auto equal = [&](const RowPoint& a, const RowPoint& b) { return order(a, b) == 0; };
  points.erase(std::unique(points.begin(), points.end(), equal), points.end());
  return points;
}

Areas::Areas(comm::Communicator& communicator, std::span<const RowPoint> points,
             const DistributedOptions& options, int spared)
    : spared_(spared),
      cut_(cut_points(communicator, points, options.triangulate.dim, communicator.size() - spared,
                      *loadbalance::find_partitioner(options.partition))) {}

std::vector<RowPoint> send_points(comm::Communicator& communicator,
                                  std::span<const RowPoint> points, std::span<const int> ranks) {
  std::vector<std::size_t> places(static_cast<std::size_t>(communicator.size()) + 1);
  for (const int rank : ranks) ++places[static_cast<std::size_t>(rank) + 1];
  for (std::size_t i = 1; i < places.size(); ++i) places[i] += places[i - 1];
  std::vector<std::size_t> next(places.begin(), places.end() - 1);
  std::vector<RowPoint> sorted(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    sorted[next[static_cast<std::size_t>(ranks[i])]++] = points[i];
  }
  std::vector<comm::Parcel> parcels;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    const auto first = places[static_cast<std::size_t>(rank)];
    const auto count = places[static_cast<std::size_t>(rank) + 1] - first;
    if (count == 0) continue;
    const std::span<const RowPoint> own = std::span(sorted).subspan(first, count);
    parcels.push_back({rank, comm::Buffer::of(own)});
  }
  std::vector<RowPoint> received;
  for (const comm::Parcel& parcel : comm::exchange(communicator, std::move(parcels))) {
    const auto some = parcel.message.as<RowPoint>();
    received.insert(received.end(), some.begin(), some.end());
  }
  return received;
}

std::vector<RowPoint> Areas::own_points(comm::Communicator& communicator,
                                        std::span<const RowPoint> points, int dim) const {
  std::vector<int> ranks;
  for (const RowPoint& point : points) ranks.push_back(rank_of(point.position));
  return distinct_points(send_points(communicator, points, ranks), dim);
}

}  // namespace delray::delaunay
