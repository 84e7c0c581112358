// Shares the rows of points out to ranks and brings together on rank 0 what they make of them.
#include "apps/triangulate_tiles.h"

#include <functional>
#include <span>

#include "comm/collectives.h"

namespace delray::apps {

std::vector<delaunay::RowPoint> own_rows(const comm::Communicator& communicator,
                                         const delaunay::PointCloud& points) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t first = points.size() * rank / ranks, last = points.size() * (rank + 1) / ranks;
  std::vector<delaunay::RowPoint> mine;
  mine.reserve(last - first);
  for (std::size_t row = first; row < last; ++row) mine.push_back({points.positions[row], row});
  return mine;
}

TiledRun gather_parts(comm::Communicator& communicator, const delaunay::TiledTriangulation& part,
                      bool with_vertices) {
  TiledRun run;
  run.rounds = part.rounds;
  run.hash =
      comm::all_reduce_value(communicator, delaunay::hash(part.dim, part.vertices), std::plus<>());
  std::uint64_t counts[] = {part.vertices.size() / (static_cast<std::size_t>(part.dim) + 1),
                            part.distinct, part.hull_facets};
  comm::all_reduce(communicator, std::span<std::uint64_t>(counts), std::plus<>());
  run.simplices = counts[0];
  run.triangulation.dim = part.dim;
  run.triangulation.distinct = counts[1];
  run.triangulation.hull_facets = counts[2];
  for (const comm::Buffer& tiles :
       comm::gather(communicator, 0,
                    comm::Buffer::of(std::span<const delaunay::TileStatistics>(part.tiles)))) {
    const auto received = tiles.as<delaunay::TileStatistics>();
    run.tiles.insert(run.tiles.end(), received.begin(), received.end());
  }
  if (with_vertices) {
    // Rows of points that one rank has all of have 32 bits.
    const std::vector<std::uint32_t> rows(part.vertices.begin(), part.vertices.end());
    for (const comm::Buffer& vertices :
         comm::gather(communicator, 0, comm::Buffer::of(std::span<const std::uint32_t>(rows)))) {
      const auto received = vertices.as<std::uint32_t>();
      run.triangulation.vertices.insert(run.triangulation.vertices.end(), received.begin(),
                                        received.end());
    }
  }
  return run;
}

TiledRun triangulate_by_ranks(comm::Communicator& communicator, const delaunay::PointCloud& points,
                              const delaunay::TileOptions& options, bool with_vertices) {
  return gather_parts(
      communicator,
      delaunay::triangulate_tiles(communicator, own_rows(communicator, points), options),
      with_vertices);
}

Json tiles_json(const TiledRun& run) {
  Json tiles = Json::array();
  for (const delaunay::TileStatistics& tile : run.tiles) {
    tiles.push_back({{"points", tile.points},
                     {"halo", tile.halo},
                     {"sent", tile.sent},
                     {"simplices", tile.simplices},
                     {"own_simplices", tile.own_simplices}});
  }
  return tiles;
}

}  // namespace delray::apps
