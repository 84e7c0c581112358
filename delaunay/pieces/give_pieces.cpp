// Sorts simplices by the cell of a grid in which their lowest row lies, cells along a Morton curve,
// and cuts the order into runs.
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/triangulation_pieces.h"
#include "geometry/box.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

constexpr std::size_t kPiecesGrain = 16384;  // simplices: some tenths of a millisecond

// The bits of x with `gap` zeros between them.
std::uint32_t spread_bits(std::uint32_t x, int gap) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 8; ++bit) result |= (x >> bit & 1) << (bit * (gap + 1));
  return result;
}

// Cells of a grid of 2^8 a side, or 2^5 in space, along a Morton curve.
class MortonGrid {
 public:
  MortonGrid(PointView<double> points, int dim) : dim_(dim), cells_(dim == 2 ? 256 : 32) {
    box_ = parallel::parallel_reduce(
        0, points.size(), kPiecesGrain, geometry::Box3d(),
        [&](std::size_t first, std::size_t last) {
          geometry::Box3d box;
          for (std::size_t i = first; i < last; ++i) box.include(place(points, i));
          return box;
        },
        [](geometry::Box3d a, const geometry::Box3d& b) {
          a.include(b);
          return a;
        });
    for (std::uint32_t i = 0; i < cells_; ++i) spread_.push_back(spread_bits(i, dim - 1));
    for (int k = 0; k < dim; ++k) {
      // Halves, so that the size of a box of huge coordinates is finite.
      const double size = box_.high[k] / 2 - box_.low[k] / 2;
      scale_[k] = size > 0 ? cells_ / size : 0;
    }
  }
  std::size_t keys() const { return dim_ == 2 ? 1 << 16 : 1 << 15; }
  std::uint16_t key(PointView<double> points, std::size_t row) const {
    std::uint32_t key = 0;
    for (int k = 0; k < dim_; ++k) {
      const double cell = (points(row, k) / 2 - box_.low[k] / 2) * scale_[k];
      key |= spread_[static_cast<std::uint32_t>(std::clamp(cell, 0.0, cells_ - 1.0))] << k;
    }
    return static_cast<std::uint16_t>(key);
  }

 private:
  glm::dvec3 place(PointView<double> points, std::size_t i) const {
    return {points(i, 0), points(i, 1), dim_ == 3 ? points(i, 2) : 0.0};
  }
  int dim_;
  std::uint32_t cells_;
  geometry::Box3d box_;
  glm::dvec3 scale_{0};
  std::vector<std::uint32_t> spread_;
};

// The numbers of simplices by ascending keys, those of equal keys in their order: a counting sort
// with a histogram for each run.
std::vector<std::uint32_t> sorted_by_cells(PointView<double> points,
                                           const Triangulation& triangulation) {
  const MortonGrid grid(points, triangulation.dim);
  const std::size_t corners = static_cast<std::size_t>(triangulation.dim) + 1;
  const std::size_t n = triangulation.size();
  constexpr std::size_t kMostRuns = 32;  // histograms of 256 kB
  const std::size_t runs = std::clamp<std::size_t>(n / kPiecesGrain, 1, kMostRuns);
  std::vector<std::uint16_t> keys(n);
  std::vector<std::vector<std::uint32_t>> next(runs, std::vector<std::uint32_t>(grid.keys()));
  const auto for_run = [&](std::size_t run, auto&& f) {
    for (std::size_t i = n * run / runs; i < n * (run + 1) / runs; ++i) f(i);
  };
  parallel::parallel_for(0, runs, 1, [&](std::size_t run) {
    for_run(run, [&](std::size_t i) {
      const std::uint32_t* v = triangulation.vertices.data() + i * corners;
      keys[i] = grid.key(points, *std::min_element(v, v + corners));
      ++next[run][keys[i]];
    });
  });
  std::uint32_t sum = 0;
  for (std::size_t key = 0; key < grid.keys(); ++key) {
    for (std::vector<std::uint32_t>& of_run : next) sum += std::exchange(of_run[key], sum);
  }
  std::vector<std::uint32_t> sorted(n);
  parallel::parallel_for(0, runs, 1, [&](std::size_t run) {
    for_run(run,
            [&](std::size_t i) { sorted[next[run][keys[i]]++] = static_cast<std::uint32_t>(i); });
  });
  return sorted;
}

// Numbers rows in the order in which they are first asked for: a hash table with open addressing,
// at most half full.
class RowNumbers {
 public:
  // The number of a row, and whether it is new.
  std::pair<std::uint32_t, bool> number(std::uint32_t row) {
    Slot& slot = find(row);
    if (slot.number != kFree) return {slot.number, false};
    slot = {row, next_};
    const std::pair<std::uint32_t, bool> result{next_++, true};
    if (std::size_t{2} * next_ > slots_.size()) grow();
    return result;
  }

 private:
  static constexpr std::uint32_t kFree = 0xffffffff;
  struct Slot {
    std::uint32_t row = 0, number = kFree;
  };
  Slot& find(std::uint32_t row) {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (row * kOdd >> 32) & mask;
    while (slots_[at].number != kFree && slots_[at].row != row) at = (at + 1) & mask;
    return slots_[at];
  }
  void grow() {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& slot : old) {
      if (slot.number != kFree) find(slot.row) = slot;
    }
  }

  std::vector<Slot> slots_ = std::vector<Slot>(1024);
  std::uint32_t next_ = 0;
};

struct RunOfSimplices {
  std::vector<RowPoint> points;
  std::vector<std::uint32_t> simplices;
};

RowPoint row_point(PointView<double> points, bool has_z, std::size_t row) {
  return {{points(row, 0), points(row, 1), has_z ? points(row, 2) : 0.0}, row};
}

RunOfSimplices collect_run(PointView<double> points, bool has_z, const Triangulation& triangulation,
                           std::span<const std::uint32_t> simplices) {
  const std::size_t corners = static_cast<std::size_t>(triangulation.dim) + 1;
  RunOfSimplices run;
  run.simplices.reserve(simplices.size() * corners);
  // A triangulation in the plane has half as many vertices, one in space a sixth or so.
  run.points.reserve(simplices.size() * 2 / corners);
  RowNumbers numbers;
  for (const std::uint32_t simplex : simplices) {
    const std::uint32_t* v = triangulation.vertices.data() + simplex * corners;
    for (std::size_t k = 0; k < corners; ++k) {
      const auto [number, is_new] = numbers.number(v[k]);
      if (is_new) run.points.push_back(row_point(points, has_z, v[k]));
      run.simplices.push_back(number);
    }
  }
  return run;
}

}  // namespace

void give_pieces(PointView<double> points, const Triangulation& triangulation, std::uint64_t most,
                 TileSink& sink) {
  const bool has_z = points.stride >= 3 * sizeof(double);
  const std::vector<std::uint32_t> sorted = sorted_by_cells(points, triangulation);
  const std::size_t pieces = (sorted.size() + most - 1) / most;
  parallel::parallel_for(0, pieces, 1, [&](std::size_t piece) {
    // Runs of nearly equal length.
    const std::size_t first = sorted.size() * piece / pieces;
    const std::size_t last = sorted.size() * (piece + 1) / pieces;
    const RunOfSimplices run =
        collect_run(points, has_z, triangulation, std::span(sorted).subspan(first, last - first));
    sink.take({triangulation.dim, piece, run.points, run.simplices});
  });
}

void give_runs(PointView<double> points, const Triangulation& triangulation, std::uint64_t most,
               TileSink& sink) {
  const bool has_z = points.stride >= 3 * sizeof(double);
  std::vector<RowPoint> all(points.size());
  parallel::parallel_for(0, all.size(), kPiecesGrain,
                         [&](std::size_t row) { all[row] = row_point(points, has_z, row); });
  const std::size_t corners = static_cast<std::size_t>(triangulation.dim) + 1;
  const std::span<const std::uint32_t> simplices = triangulation.vertices;
  const std::size_t runs = (triangulation.size() + most - 1) / most;
  parallel::parallel_for(0, runs, 1, [&](std::size_t run) {
    const std::size_t first = triangulation.size() * run / runs;
    const std::size_t last = triangulation.size() * (run + 1) / runs;
    sink.take({triangulation.dim, run, all,
               simplices.subspan(first * corners, (last - first) * corners)});
  });
}

}  // namespace delray::delaunay
