// Numbers the blocks of a frame row by row and clips those at its border.
#include "loadbalance/task_grid.h"

#include <stdexcept>

namespace delray::loadbalance {

TaskGrid Blocks::grid() const {
  if (width < 1 || height < 1) throw std::invalid_argument("a block has at least one pixel");
  if (frame.empty()) return {0, 0};
  return {static_cast<std::uint32_t>((frame.width() - 1) / width + 1),
          static_cast<std::uint32_t>((frame.height() - 1) / height + 1)};
}

geometry::Rect Blocks::block(std::uint32_t task) const {
  const std::uint32_t columns = grid().columns;
  const int x = frame.x0 + static_cast<int>(task % columns) * width;
  const int y = frame.y0 + static_cast<int>(task / columns) * height;
  return geometry::intersection({x, y, x + width, y + height}, frame);
}

}  // namespace delray::loadbalance
