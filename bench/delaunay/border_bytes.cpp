// What tiles tell each other for a point of a border, as ranks grow (simulated, counted):
//
//   delaunay_border_bytes [--ranks N,N,...] [--points N] [--dim 2|3]
//
// Each rank has one tile with about `points` uniform points. Bytes are those of the exchanges of
// halos, after the points have come to their tiles: the points themselves, and the headers by which
// ranks find each other (comm::exchange). A point of a border is one that another tile was told of,
// once for each. The last column is its bytes over those of the first line.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "bench/delaunay/on_simulated_ranks.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "delaunay/mesh/random.h"
#include "delaunay/tiles.h"

namespace {

using namespace delray;

struct BorderTraffic {
  std::uint64_t points = 0, told = 0, bytes = 0, header_bytes = 0;
};

BorderTraffic traffic_of(int ranks, std::size_t points_per_rank, int dim) {
  BorderTraffic sum;
  bench::on_simulated_ranks(ranks, [&](comm::Communicator& communicator) {
    std::vector<delaunay::RowPoint> mine;
    for (std::size_t i = 0; i < points_per_rank; ++i) {
      const std::uint64_t row =
          static_cast<std::uint64_t>(communicator.rank()) * points_per_rank + i;
      delaunay::RowRandom random(1, row);
      const double x = random.uniform(), y = random.uniform();
      mine.push_back({{x, y, random.uniform()}, row});
    }
    delaunay::TileOptions options;
    options.triangulate.dim = dim;
    std::vector<comm::Event> events;
    comm::Recording recording(communicator, events);
    const auto made = triangulate_tiles(recording, mine, options);
    // The gathering of summaries comes between the points' way to their tiles and the halos.
    bool is_halo = false;
    for (const comm::Event& event : events) {
      if (event.kind != comm::Event::Kind::send) continue;
      if (event.tag == comm::kTagAllGather) is_halo = true;
      if (!is_halo || event.peer == communicator.rank()) continue;
      if (event.tag == comm::kTagExchange) sum.bytes += event.amount;
      if (event.tag == comm::kTagExchangeHeaders) sum.header_bytes += event.amount;
    }
    for (const delaunay::TileStatistics& tile : made.tiles) {
      sum.points += tile.points;
      sum.told += tile.sent;
    }
  });
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> ranks = {4, 16, 64, 256};
  std::size_t points = 3000;
  int dim = 2;
  CLI::App app("Bytes that tiles tell each other for a point of a border");
  app.add_option("--ranks", ranks)->delimiter(',');
  app.add_option("--points", points);
  app.add_option("--dim", dim)->check(CLI::IsMember({2, 3}));
  CLI11_PARSE(app, argc, argv);
  std::printf("%6s %12s %12s %12s %12s %14s %8s\n", "ranks", "points", "told", "per rank", "bytes",
              "bytes/point", "ratio");
  double first = 0;
  for (const int count : ranks) {
    const BorderTraffic traffic = traffic_of(count, points, dim);
    const auto told = static_cast<double>(traffic.told);
    const auto bytes = static_cast<double>(traffic.bytes + traffic.header_bytes);
    if (first == 0) first = bytes / told;
    std::printf("%6d %12llu %12llu %12.1f %12.0f %14.2f %8.3f\n", count,
                static_cast<unsigned long long>(traffic.points),
                static_cast<unsigned long long>(traffic.told), told / count, bytes, bytes / told,
                bytes / told / first);
    std::fflush(stdout);
  }
  return 0;
}
