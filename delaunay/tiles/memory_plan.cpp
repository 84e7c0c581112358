// Sizes tiles so that those in the making fit memory together, with what neighbours leave; points
// themselves wait on disk unless they fit, too.
#include "delaunay/tiles/memory_plan.h"

#include <algorithm>

#include "delaunay/tiles/tile_cut.h"
#include "files/error.h"
#include "files/memory_budget.h"

namespace delray::delaunay {
namespace {

// For the program's own small things, and what allocators keep.
constexpr std::uint64_t kReserve = std::uint64_t{48} << 20;
// Of the memory that is left, what tiles in the making may take; rests wait in some of the others.
constexpr double kTilesShare = 0.75;
// Tiles of more points than that are slower in 2D: a smaller part of them lies at borders, but they
// leave the cache. In 3D borders cost more.
constexpr std::uint64_t kLargeTile2D = std::uint64_t{1} << 20;
// Fewer points leave too many of them at borders for several tiles at a time.
constexpr std::uint64_t kSmallTile = 200000, kSmallestTile = 4000;
// Tiles come out uneven by as much, unless points cluster in few cells of the grid.
constexpr double kUneven = 1.15;
constexpr std::uint64_t kBytesToRead = 120;    // of a point, and its copy sorted by tiles
constexpr std::uint64_t kBytesToSample = 120;  // with the copies on the way
constexpr std::uint64_t kMostRows = std::uint64_t{1} << 20;

}  // namespace

std::uint64_t bytes_to_triangulate(int dim) {
  // Measured: while a tile is triangulated and copied out, its points and their sorted copy
  // included.
  constexpr std::uint64_t kBytes2D = 150, kBytes3D = 400;
  return dim == 2 ? kBytes2D : kBytes3D;
}

MemoryPlan plan_memory(const Task& task) {
  MemoryPlan plan;
  plan.threads = std::max(1, task.threads);
  plan.batch_rows = kMostRows;
  const auto use_sample = [&](std::uint64_t most) {
    plan.sample =
        std::min<std::uint64_t>(sample_for_tiles(static_cast<std::uint64_t>(plan.tiles)), most);
  };
  const std::uint64_t bytes = bytes_to_triangulate(task.dim);
  const std::uint64_t share = task.points / static_cast<std::uint64_t>(task.ranks) + 1;
  plan.tiles = task.tiles > 0 ? task.tiles : task.ranks;
  if (task.tiles == 0 && task.dim == 2) {
    plan.tiles *=
        static_cast<int>(std::min((share + kLargeTile2D - 1) / kLargeTile2D, std::uint64_t{1000}));
  }
  const auto use_workers = [&](std::uint64_t most) {
    const int per_rank = std::max(1, plan.tiles / task.ranks);
    const int workers = static_cast<int>(std::min<std::uint64_t>(most, per_rank));
    plan.workers = std::clamp(workers, 1, std::max(1, task.threads));
    plan.threads = std::max(1, task.threads / plan.workers);
  };
  if (task.memory == 0) {
    plan.tile_points = ~std::uint64_t{0};
    use_sample(~std::uint64_t{0});
    use_workers(static_cast<std::uint64_t>(std::max(1, task.threads)));
    return plan;
  }
  const std::uint64_t resident = files::resident_set() + kReserve;
  const std::uint64_t left = task.memory > resident ? task.memory - resident : 0;
  plan.batch_rows =
      std::clamp(left / 4 / kBytesToRead / static_cast<std::uint64_t>(std::max(1, task.threads)),
                 std::uint64_t{1024}, kMostRows);
  constexpr std::uint64_t kBytesInMemory = 40;
  plan.on_disk = share * (kBytesInMemory + bytes) > left;
  int workers = std::max(1, task.threads);
  const auto largest = [&] {
    return static_cast<std::uint64_t>(kTilesShare * static_cast<double>(left) / workers /
                                      static_cast<double>(bytes));
  };
  while (workers > 1 && largest() < kSmallTile) workers /= 2;
  plan.tile_points = largest();
  if (plan.tile_points < kSmallestTile) {
    const auto least =
        static_cast<std::uint64_t>(static_cast<double>((kSmallestTile + 1) * bytes) / kTilesShare);
    // Of what is given more, at least half comes here.
    const std::uint64_t more = 2 * (resident + least - task.memory) + (1 << 20);
    throw files::FileError(files::Cause::memory, "--memory", "",
                           "tiles of points need " + files::bytes_text(resident + least) +
                               ", and " + files::bytes_text(task.memory) +
                               " are left for them: " + files::bytes_text(more) + " more will do");
  }
  if (task.tiles == 0 && (plan.on_disk || share > plan.tile_points)) {
    std::uint64_t wanted = plan.tile_points;
    if (task.dim == 2) wanted = std::min(wanted, kLargeTile2D);
    const double tiles =
        kUneven * static_cast<double>(task.points) / static_cast<double>(wanted) + 1;
    plan.tiles = static_cast<int>(std::clamp(tiles, double(task.ranks), 1e6));
  }
  use_sample(std::max(left / 8 / kBytesToSample, kSmallestTile));
  use_workers(static_cast<std::uint64_t>(workers));
  return plan;
}

void require_memory_for_rest(std::uint64_t points, int dim, std::uint64_t memory) {
  if (memory == 0) return;
  const std::uint64_t bytes = points * bytes_to_triangulate(dim);
  const std::uint64_t resident = files::resident_set();
  if (resident + bytes <= memory) return;
  throw files::FileError(
      files::Cause::memory, "--memory", "",
      std::to_string(points) +
          " points have simplices whose circumscribed balls reach other tiles, as points on one "
          "circle or sphere do, and must be triangulated at once; that takes " +
          files::bytes_text(bytes) + ", the program has " + files::bytes_text(resident) +
          " and may have " + files::bytes_text(memory));
}

}  // namespace delray::delaunay
