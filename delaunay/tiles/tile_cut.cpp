// Cuts space into tiles of about as many points: the counts of a slab's cells are the costs that a
// partition of loadbalance/ cuts by.
#include "delaunay/tiles/tile_cut.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "loadbalance/costs.h"

namespace delray::delaunay {
namespace {

// A slab [first, last) of cells across an axis, and its tiles.
struct Slab {
  int first = 0, last = 0;
  int first_tile = 0, tiles = 0;
};

// As thick as columns are wide, in cells.
int slabs_for(const std::array<int, 3>& cells, int axis, int tiles) {
  double columns = tiles;
  for (int k = 0; k < 3; ++k) {
    if (k != axis) columns *= double(cells[axis]) / cells[k];
  }
  return std::clamp(static_cast<int>(std::lround(std::cbrt(columns))), 1,
                    std::min(tiles, cells[axis]));
}

std::vector<Slab> cut_slabs(std::span<const std::uint64_t> layers, int slabs, int tiles) {
  std::uint64_t total = 0;
  for (const std::uint64_t layer : layers) total += layer;
  std::vector<Slab> result;
  std::uint64_t below = 0;
  int layer = 0;
  for (int slab = 0; slab < slabs; ++slab) {
    const int first_tile = static_cast<int>(std::int64_t{slab} * tiles / slabs);
    const int end_tile = static_cast<int>(std::int64_t{slab + 1} * tiles / slabs);
    const double wanted = static_cast<double>(total) * end_tile / tiles;
    const int first = layer;
    while (layer < static_cast<int>(layers.size()) &&
           (slab + 1 == slabs || static_cast<double>(below + layers[layer] / 2) < wanted)) {
      below += layers[layer++];
    }
    result.push_back({first, layer, first_tile, end_tile - first_tile});
  }
  return result;
}

}  // namespace

int cells_along_axis(int dim, std::uint64_t tiles) {
  constexpr double kPerTile2D = 64, kPerTile3D = 24, kMost2D = 4096, kMost3D = 256;
  const auto n = static_cast<double>(std::max<std::uint64_t>(tiles, 1));
  return static_cast<int>(dim == 2 ? std::min(kMost2D, std::ceil(kPerTile2D * std::sqrt(n)))
                                   : std::min(kMost3D, std::ceil(kPerTile3D * std::cbrt(n))));
}

TileCut::TileCut(const CellLattice& lattice, std::span<const std::uint64_t> counts, int tiles,
                 const loadbalance::Partitioner& partitioner)
    : lattice_(lattice), tiles_(tiles), owner_(lattice.cells()) {
  std::array<int, 3> cells;
  std::array<std::size_t, 3> stride;
  for (int k = 0; k < 3; ++k) {
    cells[k] = lattice.cells_along(k);
    stride[k] = k == 0 ? 1 : stride[k - 1] * static_cast<std::size_t>(cells[k - 1]);
  }
  // In 2D there is one cell along z.
  const int across = static_cast<int>(std::ranges::min_element(cells) - cells.begin());
  const int axis = cells[2] == 1 ? 2 : across;
  const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  std::vector<std::uint64_t> layers(static_cast<std::size_t>(cells[axis]));
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    layers[cell / stride[axis] % layers.size()] += counts[cell];
  }
  const int slabs = cells[axis] == 1 ? 1 : slabs_for(cells, axis, tiles);
  for (const Slab& slab : cut_slabs(layers, slabs, tiles)) {
    if (slab.first == slab.last || slab.tiles == 0) continue;
    loadbalance::Costs costs{{0, 0, cells[u], cells[v]}, cells[u], cells[v], {}, {}, {}, {}};
    const std::size_t area =
        static_cast<std::size_t>(cells[u]) * static_cast<std::size_t>(cells[v]);
    costs.cells.resize(area);
    costs.cross_right.resize(area);
    costs.cross_down.resize(area);
    const auto each_cell = [&](const geometry::Rect& rect, const auto& f) {
      for (int k = slab.first; k < slab.last; ++k) {
        for (int y = rect.y0; y < rect.y1; ++y) {
          for (int x = rect.x0; x < rect.x1; ++x) {
            f(k * stride[axis] + x * stride[u] + y * stride[v],
              static_cast<std::size_t>(y) * static_cast<std::size_t>(cells[u]) +
                  static_cast<std::size_t>(x));
          }
        }
      }
    };
    each_cell(costs.frame, [&](std::size_t cell, std::size_t column) {
      costs.cells[column] += static_cast<double>(counts[cell]);
    });
    for (const loadbalance::Region& region :
         partitioner.partition(costs, costs.frame, slab.tiles).regions) {
      each_cell(region.rect, [&](std::size_t cell, std::size_t) {
        owner_[cell] = slab.first_tile + region.owner;
      });
    }
  }
}

std::vector<std::uint64_t> TileCut::points_of_tiles(std::span<const std::uint64_t> counts) const {
  std::vector<std::uint64_t> points(static_cast<std::size_t>(tiles_));
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    points[static_cast<std::size_t>(owner_[cell])] += counts[cell];
  }
  return points;
}

int rank_of_tile(int tile, int ranks, int tiles) {
  int rank = static_cast<int>(std::int64_t{tile} * ranks / tiles);
  while (first_tile(rank + 1, ranks, tiles) <= tile) ++rank;
  while (first_tile(rank, ranks, tiles) > tile) --rank;
  return rank;
}

}  // namespace delray::delaunay
