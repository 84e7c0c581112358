// Counts of points on a grid of cubes, whose box need not be known before.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "delaunay/points.h"
#include "geometry/box.h"

namespace delray::delaunay {

// Where cells lie: their side is a power of two, so that grids of two boxes have a common one whose
// cells are unions of cells of both.
class CellLattice {
 public:
  CellLattice() = default;
  // The finest cells of which at most `most` along an axis, and at least one, cover the box.
  // REQUIRES: the box is finite and not empty; most >= 2, as 0 is a border of cells of all sizes.
  CellLattice(const geometry::Box3d& box, int dim, int most);

  const geometry::Box3d& box() const { return box_; }
  int cells_along(int axis) const { return static_cast<int>(size_[axis]); }
  std::size_t cells() const { return static_cast<std::size_t>(size_[0] * size_[1] * size_[2]); }
  // x first, then y. REQUIRES: the place is in the box.
  std::size_t cell_of(const glm::dvec3& place) const {
    std::int64_t cell = 0;
    for (int k = 2; k >= 0; --k) cell = cell * size_[k] + (index(place[k], k) - first_[k]);
    return static_cast<std::size_t>(cell);
  }
  // The cell of this lattice that cell number `cell` of a finer or equal lattice lies in. REQUIRES:
  // this one's box holds the other's.
  std::size_t cell_of(const CellLattice& finer, std::size_t cell) const;

 private:
  std::int64_t index(double x, int axis) const {
    const double place = x * scale_[axis];
    const auto towards_zero = static_cast<std::int64_t>(place);
    return towards_zero - (static_cast<double>(towards_zero) > place ? 1 : 0);
  }

  geometry::Box3d box_{glm::dvec3(0), glm::dvec3(0)};
  int exponent_ = 0;                         // of the side
  std::array<double, 3> scale_ = {1, 1, 0};  // 2^-exponent_; 0 along axes without cells
  std::array<std::int64_t, 3> first_ = {0, 0, 0}, size_ = {1, 1, 1};
};

// Counts points whose box grows: where it does, cells are put together.
class CountGrid {
 public:
  CountGrid(int dim, int most) : dim_(dim), most_(most) {}

  // Makes the grid cover the box.
  void cover(const geometry::Box3d& box);
  // REQUIRES: the place is covered.
  void add(const glm::dvec3& place) { ++counts_[lattice_.cell_of(place)]; }
  // The counts of another grid as well.
  void add(const CountGrid& other);

  int dim() const { return dim_; }
  const geometry::Box3d& box() const { return box_; }
  const CellLattice& lattice() const { return lattice_; }
  std::span<std::uint64_t> counts() { return counts_; }
  std::span<const std::uint64_t> counts() const { return counts_; }

 private:
  int dim_, most_;
  geometry::Box3d box_;
  CellLattice lattice_;
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(1);
};

}  // namespace delray::delaunay
