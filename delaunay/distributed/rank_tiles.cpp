// The tiles of delaunay/tiles.h as one of the methods, with what the others count beside it.
//
// Which simplices are shared is found out after the run: rank r mod n is told in which area row r
// lies, and whoever has simplices asks it.
#include <algorithm>
#include <unordered_map>
#include <vector>

#include "comm/collectives.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/method_sources.h"

namespace delray::delaunay {
namespace {

struct RowArea {
  std::uint64_t row = 0;
  std::int64_t area = 0;
};

// What each rank has for each other rank; returns what came, by ascending sender.
template <class T>
std::vector<comm::Parcel> exchange_lists(comm::Communicator& communicator,
                                         const std::vector<std::vector<T>>& lists) {
  std::vector<comm::Parcel> parcels;
  for (std::size_t rank = 0; rank < lists.size(); ++rank) {
    if (lists[rank].empty()) continue;
    parcels.push_back({static_cast<int>(rank), comm::Buffer::of(std::span<const T>(lists[rank]))});
  }
  return comm::exchange(communicator, std::move(parcels));
}

std::unordered_map<std::uint64_t, std::int64_t> received_areas(
    const std::vector<comm::Parcel>& parcels) {
  std::unordered_map<std::uint64_t, std::int64_t> areas;
  for (const comm::Parcel& parcel : parcels) {
    for (const RowArea& each : parcel.message.as<RowArea>()) areas[each.row] = each.area;
  }
  return areas;
}

}  // namespace

std::uint64_t count_shared_rows(comm::Communicator& communicator, std::span<const RowPoint> points,
                                const DistributedOptions& options, const TiledTriangulation& part) {
  const Areas areas(communicator, points, options);
  const auto ranks = static_cast<std::size_t>(communicator.size());
  std::vector<std::vector<RowArea>> told(ranks);
  for (const RowPoint& point : points) {
    told[point.row % ranks].push_back({point.row, areas.rank_of(point.position)});
  }
  const auto kept = received_areas(exchange_lists(communicator, told));

  std::vector<std::uint64_t> rows = part.vertices;
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  std::vector<std::vector<std::uint64_t>> asked(ranks);
  for (const std::uint64_t row : rows) asked[row % ranks].push_back(row);
  std::vector<std::vector<RowArea>> answers(ranks);
  for (const comm::Parcel& parcel : exchange_lists(communicator, asked)) {
    for (const std::uint64_t row : parcel.message.as<std::uint64_t>()) {
      answers[static_cast<std::size_t>(parcel.rank)].push_back({row, kept.at(row)});
    }
  }
  const auto known = received_areas(exchange_lists(communicator, answers));
  std::uint64_t shared = 0;
  const auto corners = static_cast<std::size_t>(part.dim) + 1;
  for (std::size_t s = 0; s < part.vertices.size(); s += corners) {
    const auto simplex = std::span<const std::uint64_t>(part.vertices).subspan(s, corners);
    shared += std::ranges::any_of(
        simplex, [&](std::uint64_t row) { return known.at(row) != known.at(simplex[0]); });
  }
  return shared;
}

DistributedTriangulation triangulate_by_tiles(comm::Communicator& communicator,
                                              std::span<const RowPoint> points,
                                              const DistributedOptions& options) {
  TileOptions tiles;
  tiles.partition = options.partition;
  tiles.triangulate = options.triangulate;
  DistributedTriangulation result;
  result.part = triangulate_tiles(communicator, points, tiles);
  for (const TileStatistics& tile : result.part.tiles) result.statistics.points_sent += tile.sent;
  return result;
}

}  // namespace delray::delaunay
