// A triangulation in D dimensions that points are inserted into.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/dimensions/determinants.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/xorshift.h"

namespace delray::delaunay::internal {

// Cells are simplices, positively oriented, or ghosts with the infinite vertex beyond a facet of
// the hull, as in mesh.h. Facet number 8 cell + k is the one opposite to corner k.
template <int D>
class Cells {
 public:
  using Corners = std::array<VertexNumber, D + 1>;

  // REQUIRES: `points` outlives it; the corners are not in one hyperplane.
  Cells(const std::vector<PlaceNd<D>>& points, Corners first);

  // Returns whether the limit of cells allowed it. REQUIRES: the point is no vertex, nor equal to
  // one.
  bool insert(VertexNumber vertex);

  // Of all cells, dead ones included.
  std::size_t size() const { return corners_.size(); }
  bool is_dead(std::uint32_t cell) const { return corners_[cell][0] == kDeadVertex; }
  bool is_ghost(std::uint32_t cell) const;
  const Corners& corners(std::uint32_t cell) const { return corners_[cell]; }

 private:
  using Facet = std::uint32_t;
  static constexpr Facet kMade = 0x80000000U;  // and the number of a new cell
  static constexpr std::size_t kMostCells = std::size_t{1} << 28;
  struct Border {
    std::uint32_t cell;
    unsigned corner;
  };

  std::array<const PlaceNd<D>*, D + 1> places(std::uint32_t cell) const;
  bool conflicts(std::uint32_t cell, const PlaceNd<D>& q) const;
  std::uint32_t locate(const PlaceNd<D>& q);
  void dig(std::uint32_t start, const PlaceNd<D>& q);
  std::uint32_t create();
  void link(std::uint32_t a, unsigned i, std::uint32_t b, unsigned j) {
    across_[a][i] = 8 * b + j;
    across_[b][j] = 8 * a + i;
  }
  // The new cell that shares the ridge opposite to corners k and j of a removed one.
  void link_around(std::uint32_t made, std::uint32_t cell, unsigned k, unsigned j);

  const std::vector<PlaceNd<D>>& points_;
  std::vector<Corners> corners_;
  std::vector<std::array<Facet, D + 1>> across_;
  std::vector<std::uint64_t> marks_;  // of each cell: what the last insertion to test it found
  std::uint64_t insertions_ = 0;
  std::vector<std::uint32_t> free_, removed_;
  std::vector<Border> border_;
  std::uint32_t last_ = 0;  // a finite cell
  std::uint32_t random_ = 1;
};

extern template class Cells<2>;
extern template class Cells<3>;
extern template class Cells<4>;
extern template class Cells<5>;
extern template class Cells<6>;

}  // namespace delray::delaunay::internal
