// Builds a summed-area table (Crow 1984) row by row: the sum of the row so far plus the entry
// above. O(cells).
#include "loadbalance/partitions/summed_area.h"

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace delray::loadbalance {

SummedArea::SummedArea(int columns, int rows, std::span<const double> cells)
    : stride_(static_cast<std::size_t>(columns) + 1),
      table_(stride_ * (static_cast<std::size_t>(rows) + 1)) {
  if (columns < 0 || rows < 0 ||
      cells.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("the cells are not as many as columns times rows");
  std::size_t k = 0;
  for (std::size_t j = 1; j <= static_cast<std::size_t>(rows); ++j) {
    double row = 0;
    for (std::size_t i = 1; i < stride_; ++i) {
      assert(std::isfinite(cells[k]));
      row += cells[k++];
      table_[j * stride_ + i] = table_[(j - 1) * stride_ + i] + row;
    }
  }
}

}  // namespace delray::loadbalance
