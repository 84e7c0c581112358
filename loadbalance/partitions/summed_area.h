// Sums over rectangles of a grid in constant time.
#pragma once

#include <span>
#include <vector>

#include "geometry/rect.h"

namespace delray::loadbalance {

// A summed-area table (Crow 1984): at each cell, the sum of all cells above and to the left of it,
// itself included. O(cells) to build, as many doubles.
class SummedArea {
 public:
  // REQUIRES: columns, rows >= 0; cells.size() == columns * rows, row-major; all finite.
  SummedArea(int columns, int rows, std::span<const double> cells);

  // The table's value at cell (i, j). REQUIRES: -1 <= i < columns, -1 <= j < rows; 0 where either
  // is -1.
  double at(int i, int j) const {
    return table_[static_cast<std::size_t>(j + 1) * stride_ + static_cast<std::size_t>(i + 1)];
  }
  // The sum over the cells of `rect`; exact where all sums are exactly representable, otherwise
  // with the rounding of the whole table. REQUIRES: `rect` lies in the grid, x0 <= x1, y0 <= y1.
  double sum(const geometry::Rect& rect) const {
    return (at(rect.x1 - 1, rect.y1 - 1) - at(rect.x0 - 1, rect.y1 - 1)) -
           (at(rect.x1 - 1, rect.y0 - 1) - at(rect.x0 - 1, rect.y0 - 1));
  }

 private:
  std::size_t stride_;
  std::vector<double> table_;  // (rows + 1) * stride_, the first row and column 0
};

}  // namespace delray::loadbalance
