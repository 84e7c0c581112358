// Cuts space into tiles of about as many points: a grid of counts, summed over ranks, that a
// partition of loadbalance/ takes for costs.
#include "delaunay/tiles/tile_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "comm/collectives.h"
#include "loadbalance/costs.h"

namespace delray::delaunay {
namespace {

// Fine enough that a cell has a small share of a tile's points, unless they are all in one place.
int cells_along(int tiles) {
  constexpr double kCellsPerTile = 1024, kMost = 4096;
  return static_cast<int>(std::min(kMost, std::ceil(std::sqrt(kCellsPerTile * tiles))));
}

geometry::Box3d box_of_all(comm::Communicator& communicator, std::span<const RowPoint> points) {
  geometry::Box3d box;
  for (const RowPoint& point : points) box.include(point.position);
  std::array<double, 6> bounds;
  for (int k = 0; k < 3; ++k) {
    bounds[k] = -box.low[k];
    bounds[3 + k] = box.high[k];
  }
  comm::all_reduce(communicator, std::span<double>(bounds),
                   [](double a, double b) { return std::max(a, b); });
  for (int k = 0; k < 3; ++k) {
    box.low[k] = -bounds[k];
    box.high[k] = bounds[3 + k];
  }
  return box;
}

}  // namespace

TileCut::TileCut(comm::Communicator& communicator, std::span<const RowPoint> points, int dim,
                 int tiles, const loadbalance::Partitioner& partitioner)
    : box_(box_of_all(communicator, points)), side_(cells_along(tiles)) {
  const glm::dvec3 size = box_.high * 0.5 - box_.low * 0.5;
  if (dim == 3 && size.z > std::min(size.x, size.y)) axes_[size.x < size.y ? 0 : 1] = 2;

  const std::size_t cells = static_cast<std::size_t>(side_) * side_;
  std::vector<std::uint64_t> counts(cells);
  for (const RowPoint& point : points) ++counts[cell_of(point.position)];
  comm::all_reduce(communicator, std::span<std::uint64_t>(counts), std::plus<>());
  loadbalance::Costs costs{{0, 0, side_, side_}, side_, side_, {}, {}, {}, {}};
  costs.cells.assign(counts.begin(), counts.end());
  costs.cross_right.resize(cells);
  costs.cross_down.resize(cells);

  owner_.resize(cells);
  for (const loadbalance::Region& region :
       partitioner.partition(costs, costs.frame, tiles).regions) {
    for (int y = region.rect.y0; y < region.rect.y1; ++y) {
      for (int x = region.rect.x0; x < region.rect.x1; ++x) {
        owner_[static_cast<std::size_t>(y) * side_ + x] = region.owner;
      }
    }
  }
}

std::size_t TileCut::cell_of(const glm::dvec3& position) const {
  std::size_t cell[2];
  for (int i = 0; i < 2; ++i) {
    const int k = axes_[i];
    // Halved, as the difference of large numbers may be infinite.
    const double size = box_.high[k] * 0.5 - box_.low[k] * 0.5;
    const double share = size > 0 ? (position[k] * 0.5 - box_.low[k] * 0.5) / size : 0;
    cell[i] = static_cast<std::size_t>(std::clamp(share * side_, 0.0, side_ - 1.0));
  }
  return cell[1] * side_ + cell[0];
}

int rank_of_tile(int tile, int ranks, int tiles) {
  int rank = static_cast<int>(std::int64_t{tile} * ranks / tiles);
  while (first_tile(rank + 1, ranks, tiles) <= tile) ++rank;
  while (first_tile(rank, ranks, tiles) > tile) --rank;
  return rank;
}

}  // namespace delray::delaunay
