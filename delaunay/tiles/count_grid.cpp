// Grids of counts whose cells have powers of two for sides and multiples of these for corners.
#include "delaunay/tiles/count_grid.h"

#include <algorithm>
#include <cmath>

namespace delray::delaunay {

CellLattice::CellLattice(const geometry::Box3d& box, int dim, int most) : box_(box) {
  // Cell numbers are exact in doubles, and the scale is finite and no denormal.
  constexpr int kLargestNumber = 50, kLeast = -1000;
  double longest = 0, farthest = 0;
  for (int k = 0; k < dim; ++k) {
    longest = std::max(longest, box.high[k] * 0.5 - box.low[k] * 0.5);
    farthest = std::max({farthest, std::abs(box.low[k]), std::abs(box.high[k])});
  }
  exponent_ = kLeast;
  if (longest > 0) exponent_ = std::max(kLeast, std::ilogb(longest) - std::ilogb(double(most)));
  if (farthest > 0) exponent_ = std::max(exponent_, std::ilogb(farthest) - kLargestNumber);
  for (;; ++exponent_) {
    bool fits = true;
    for (int k = 0; k < dim; ++k) {
      scale_[k] = std::ldexp(1, -exponent_);
      first_[k] = index(box.low[k], k);
      size_[k] = index(box.high[k], k) - first_[k] + 1;
      fits = fits && size_[k] <= most;
    }
    if (fits) break;
  }
}

std::size_t CellLattice::cell_of(const CellLattice& finer, std::size_t cell) const {
  const int shift = exponent_ - finer.exponent_;
  auto rest = static_cast<std::int64_t>(cell);
  std::int64_t result = 0, stride = 1;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t index = finer.first_[k] + rest % finer.size_[k];
    rest /= finer.size_[k];
    const std::int64_t mine = scale_[k] == 0 ? 0 : index >> std::min(shift, 62);
    result += stride * std::clamp(mine - first_[k], std::int64_t{0}, size_[k] - 1);
    stride *= size_[k];
  }
  return static_cast<std::size_t>(result);
}

void CountGrid::cover(const geometry::Box3d& box) {
  if (box.empty()) return;
  geometry::Box3d all = box_;
  all.include(box);
  if (all == box_) return;
  const CellLattice before = lattice_;
  const std::vector<std::uint64_t> counts = std::move(counts_);
  box_ = all;
  lattice_ = CellLattice(all, dim_, most_);
  counts_.assign(lattice_.cells(), 0);
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    if (counts[cell] > 0) counts_[lattice_.cell_of(before, cell)] += counts[cell];
  }
}

void CountGrid::add(const CountGrid& other) {
  cover(other.box_);
  for (std::size_t cell = 0; cell < other.counts_.size(); ++cell) {
    if (other.counts_[cell] > 0) {
      counts_[lattice_.cell_of(other.lattice_, cell)] += other.counts_[cell];
    }
  }
}

}  // namespace delray::delaunay
