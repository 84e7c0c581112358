// How even ranks come out in what they create (counted):
//
//   delaunay_rank_balance [--kinds NAME,...] [--ranks N,N,...] [--points N] [--dim 2|3]
//
// Each rank has one tile; points lie on ranks by turns before. Simplices are all that a rank's
// triangulations have, those of its halo and of what is made again included.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/delaunay/on_simulated_ranks.h"
#include "delaunay/generate.h"
#include "delaunay/tiles.h"

namespace {

using namespace delray;

struct Spread {
  std::uint64_t sum = 0, most = 0;
  void add(std::uint64_t value) {
    sum += value;
    most = std::max(most, value);
  }
  double over_mean(int ranks) const {
    return static_cast<double>(most) * ranks / static_cast<double>(sum);
  }
};

struct Balance {
  Spread points, created, own;
};

Balance balance_of(const std::string& kind, std::size_t points, int dim, int ranks) {
  const auto cloud = delaunay::generate_points(kind, points, dim, 1);
  Balance balance;
  bench::on_simulated_ranks(ranks, [&](comm::Communicator& communicator) {
    std::vector<delaunay::RowPoint> mine;
    const auto step = static_cast<std::size_t>(ranks);
    for (auto row = static_cast<std::size_t>(communicator.rank()); row < points; row += step)
      mine.push_back({cloud.positions[row], row});
    delaunay::TileOptions options;
    options.triangulate.dim = dim;
    const auto made = triangulate_tiles(communicator, mine, options);
    std::uint64_t own_points = 0, created = made.shared.simplices, own = 0;
    for (const delaunay::TileStatistics& tile : made.tiles) {
      own_points += tile.points;
      created += tile.simplices;
    }
    own = made.vertices.size() / (static_cast<std::size_t>(dim) + 1);
    balance.points.add(own_points);
    balance.created.add(created);
    balance.own.add(own);
  });
  return balance;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> kinds = {"uniform", "cluster", "gauss", "grid", "terrain"};
  std::vector<int> ranks = {4, 16, 64};
  std::size_t points = 160000;
  int dim = 2;
  CLI::App app("Balance of the simplices that ranks create");
  app.add_option("--kinds", kinds)->delimiter(',');
  app.add_option("--ranks", ranks)->delimiter(',');
  app.add_option("--points", points);
  app.add_option("--dim", dim)->check(CLI::IsMember({2, 3}));
  CLI11_PARSE(app, argc, argv);
  std::printf("%-12s %6s %14s %14s %14s\n", "max / mean", "ranks", "points", "created", "kept");
  for (const std::string& kind : kinds) {
    for (const int count : ranks) {
      const Balance balance = balance_of(kind, points, dim, count);
      std::printf("%-12s %6d %14.3f %14.3f %14.3f\n", kind.c_str(), count,
                  balance.points.over_mean(count), balance.created.over_mean(count),
                  balance.own.over_mean(count));
      std::fflush(stdout);
    }
  }
  return 0;
}
