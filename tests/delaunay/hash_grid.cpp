// The hash of a triangulation over all tiles, ranks, threads and kinds of points: always that of
// triangulate(), in memory (triangulate_tiles) and in parts (triangulate_parts).
//
//   delaunay_hash_grid [SEED]                  ranks are threads: 1, 2, 3, 4 and 8
//   mpirun -n N delaunay_hash_grid [SEED]      ranks are processes
//
// Runs some cells of the grid that the seed chooses, which it prints; with DELRAY_FULL_TESTS all of
// them. `if-full` as an argument is for tests/CMakeLists.txt.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/threads.h"
#include "delaunay/generate.h"
#include "delaunay/point_parts.h"
#include "delaunay/read_points.h"
#include "delaunay/tiles.h"
#include "delaunay/triangulate.h"
#include "delaunay/triangulate_parts.h"
#include "parallel/arena.h"

namespace {

using namespace delray;

struct Points {
  std::string name;
  int dim = 2;
  delaunay::PointCloud cloud;
  delaunay::Hash128 expected;
  std::uint64_t simplices = 0;
};

struct Cell {
  const Points* points = nullptr;
  int tiles = 1, threads = 1;
};

constexpr std::size_t kSampled = 12;  // cells for each number of ranks

// On a line but for some roundings.
delaunay::PointCloud nearly_collinear(std::size_t n) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<> along(0, 1), off(-1e-15, 1e-15);
  delaunay::PointCloud cloud;
  cloud.has_z = true;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = along(random);
    cloud.positions.emplace_back(t + off(random), t / 3 + off(random), -t / 7 + off(random));
  }
  return cloud;
}

// Every so many points of a file, so that about n are left; none where there is no such file.
delaunay::PointCloud lidar(const char* file, std::size_t n) {
  const std::filesystem::path path = std::filesystem::path(DELRAY_SHARED_DATA) / file;
  if (!exists(path)) return {};
  const delaunay::PointCloud all = delaunay::read_points(path);
  delaunay::PointCloud cloud;
  cloud.has_z = all.has_z;
  const std::size_t step = all.size() / n + 1;
  for (std::size_t i = 0; i < all.size(); i += step) cloud.positions.push_back(all.positions[i]);
  return cloud;
}

std::vector<Points> all_points() {
  std::vector<Points> result;
  for (const int dim : {2, 3}) {
    const std::size_t n = dim == 2 ? 1500 : 400;
    for (const char* kind : {"uniform", "cluster", "grid", "cocircular", "sphere", "duplicates"}) {
      result.push_back({kind, dim, delaunay::generate_points(kind, n, dim, 1), {}});
    }
    result.push_back({"nearly collinear", dim, nearly_collinear(n), {}});
    for (const char* file : {"CSite1-lidar.ply", "autzen_trim.las"}) {
      Points points{file, dim, lidar(file, 2 * n), {}};
      if (points.cloud.size() > 0) {
        result.push_back(std::move(points));
      } else {
        std::printf("skipped: no %s\n", file);
      }
    }
  }
  for (Points& each : result) {
    delaunay::Options options;
    options.dim = each.dim;
    const auto expected = triangulate(delaunay::view(each.cloud.positions), options).triangulation;
    each.expected = delaunay::hash(expected);
    each.simplices = expected.size();
  }
  return result;
}

std::vector<Cell> cells_of(const std::vector<Points>& points, std::uint64_t seed, int ranks) {
  std::vector<Cell> cells;
  for (const Points& each : points) {
    for (const int tiles : {1, 7, 64}) {
      for (const int threads : {1, 2}) cells.push_back({&each, tiles, threads});
    }
  }
  if (std::getenv("DELRAY_FULL_TESTS") != nullptr) return cells;
  std::mt19937_64 random(seed + static_cast<std::uint64_t>(ranks));
  std::ranges::shuffle(cells, random);
  cells.resize(std::min(cells.size(), kSampled));
  return cells;
}

// Collective: whether both ways give the triangulation.
bool holds(comm::Communicator& communicator, const Cell& cell) {
  const delaunay::PointCloud& cloud = cell.points->cloud;
  delaunay::PartsOptions in_parts;
  in_parts.tiles.tiles = cell.tiles;
  in_parts.tiles.triangulate.dim = cell.points->dim;
  in_parts.tiles.triangulate.threads = cell.threads;
  const delaunay::CloudParts parts(cloud, 97);
  const auto result = triangulate_parts(communicator, parts, in_parts, nullptr);

  std::vector<delaunay::RowPoint> mine;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (static_cast<int>(i) % communicator.size() == communicator.rank())
      mine.push_back({cloud.positions[i], i});
  }
  const auto made = triangulate_tiles(communicator, mine, in_parts.tiles);
  const auto hash =
      comm::all_reduce_value(communicator, delaunay::hash(made.dim, made.vertices), std::plus<>());
  return result.hash == cell.points->expected && result.simplices == cell.points->simplices &&
         hash == cell.points->expected;
}

struct Count {
  std::size_t cells = 0, wrong = 0;
};

Count run(comm::Communicator& communicator, const std::vector<Points>& points, std::uint64_t seed) {
  Count count;
  for (const Cell& cell : cells_of(points, seed, communicator.size())) {
    parallel::Arena arena(cell.threads);
    bool fine = false;
    arena.execute([&] { fine = holds(communicator, cell); });
    ++count.cells;
    if (fine) continue;
    ++count.wrong;
    if (communicator.rank() != 0) continue;
    std::printf("WRONG: %s, %dD, %d tiles, %d ranks, %d threads\n", cell.points->name.c_str(),
                cell.points->dim, cell.tiles, communicator.size(), cell.threads);
  }
  return count;
}

bool tell(const Count& count, const char* over, int ranks, std::uint64_t seed) {
  std::printf("%s, %d ranks: %zu cells, %zu wrong (seed %llu)\n", over, ranks, count.cells,
              count.wrong, static_cast<unsigned long long>(seed));
  std::fflush(stdout);
  return count.cells > 0 && count.wrong == 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seed = std::random_device()();
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "if-full") != 0) seed = std::strtoull(argv[i], nullptr, 10);
  }
  const parallel::AllowThreads allowed(16);
  const std::vector<Points> points = all_points();
  bool fine = true;
  if (comm::launched_by_mpi()) {
    comm::run_mpi(&argc, &argv, [&](comm::Communicator& communicator) {
      // That of rank 0 for all.
      const std::uint64_t agreed = comm::all_reduce_value(
          communicator, seed, [](std::uint64_t lower, std::uint64_t) { return lower; });
      const Count count = run(communicator, points, agreed);
      if (communicator.rank() == 0) fine = tell(count, "MPI", communicator.size(), agreed);
    });
    return fine ? 0 : 1;
  }
  for (const int ranks : {1, 2, 3, 4, 8}) {
    Count count;
    comm::run_threads(ranks, 2, [&](comm::Communicator& communicator) {
      const Count mine = run(communicator, points, seed);
      if (communicator.rank() == 0) count = mine;
    });
    fine = tell(count, "threads", ranks, seed) && fine;
  }
  return fine ? 0 : 1;
}
