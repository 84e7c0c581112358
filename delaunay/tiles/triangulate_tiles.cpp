// Cuts points that ranks have in memory into tiles, and settles these.
#include "delaunay/tiles.h"

#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "comm/agree_on_failure.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/tiles/distribute_points.h"
#include "delaunay/tiles/settle_ranks.h"
#include "delaunay/tiles/tally.h"
#include "delaunay/tiles/tile_cut.h"
#include "loadbalance/partition.h"

namespace delray::delaunay {
namespace {

void check(std::span<const RowPoint> points, const TileOptions& options) {
  internal::check_dim(options.triangulate.dim);
  if (loadbalance::find_partitioner(options.partition) == nullptr) {
    throw std::invalid_argument("'" + options.partition + "' is no partition");
  }
  if (options.tiles < 0) {
    throw std::invalid_argument("there cannot be " + std::to_string(options.tiles) + " tiles");
  }
  for (const RowPoint& point : points) {
    for (int k = 0; k < options.triangulate.dim; ++k) {
      if (!std::isfinite(point.position[k])) {
        throw std::invalid_argument("row " + std::to_string(point.row) +
                                    " has a coordinate that is not finite");
      }
    }
  }
}

// Appends simplices as rows of points.
void append_rows(const FinalSimplices& finals, std::vector<std::uint64_t>& rows) {
  const std::size_t first = rows.size();
  rows.resize(first + finals.simplices.size());
  for (std::size_t i = 0; i < finals.simplices.size(); ++i) {
    rows[first + i] = finals.points[finals.simplices[i]].row;
  }
}

}  // namespace

TiledTriangulation triangulate_tiles(comm::Communicator& communicator,
                                     std::span<const RowPoint> points, const TileOptions& options) {
  comm::all_or_none(communicator, comm::Phase::other, [&] { check(points, options); });
  const int tiles = options.tiles > 0 ? options.tiles : communicator.size();
  communicator.mark(comm::Phase::redistribute, 0);
  std::vector<std::vector<RowPoint>> own = distribute_points(communicator, points, options, tiles);
  std::vector<TileSummary> mine(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (const RowPoint& point : own[i]) mine[i].include(point, options.triangulate.dim);
  }
  const std::vector<TileSummary> summaries = share_summaries(communicator, mine);

  TiledTriangulation result;
  result.dim = options.triangulate.dim;
  std::mutex mutex;
  const auto first =
      static_cast<std::size_t>(first_tile(communicator.rank(), communicator.size(), tiles));
  Tally tally(first, own.size(), summaries.size());
  const TileWork work{
      .points =
          [&](std::size_t tile) {
            std::vector<RowPoint>& points_of_tile = own[tile - first];
            const std::size_t size = points_of_tile.size();
            return Region{std::move(points_of_tile), size, {}};
          },
      .take =
          [&](std::size_t region, Settled& settled) {
            tally.add(count_of(region, settled));
            const std::lock_guard lock(mutex);
            append_rows(settled.finals, result.vertices);
          },
  };
  SettleOptions how;
  how.triangulate = options.triangulate;
  how.finals.hash = false;
  const Exchanges exchanges = settle_ranks(communicator, summaries, how, work);
  TileStatistics& told = exchanges.of_tile ? tally.tiles.front() : tally.shared;
  told.halo = exchanges.halo;
  told.sent = exchanges.sent;
  result.distinct = tally.distinct;
  result.hull_facets = tally.hull_facets;
  result.tiles = std::move(tally.tiles);
  result.shared = tally.shared;
  result.rounds = exchanges.rounds;
  return result;
}

}  // namespace delray::delaunay
