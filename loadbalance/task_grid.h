// Numbered tasks, and the blocks of a picture that they may stand for.
#pragma once

#include <cstdint>

#include "geometry/rect.h"

namespace delray::loadbalance {

// The tasks first <= number < last.
struct TaskRange {
  std::uint32_t first = 0, last = 0;

  std::uint32_t count() const { return last - first; }
  bool operator==(const TaskRange&) const = default;
};

// Tasks in rows: column i of row j is number j * columns + i. Tasks that lie in no plane are one
// row. REQUIRES: fewer than 2^32 tasks.
struct TaskGrid {
  std::uint32_t columns = 0, rows = 1;

  std::uint32_t count() const { return columns * rows; }
};

// A frame in blocks of equal size, those of the last column and row cut off at its border: 16 x 16
// pixels by default, 3 x 3 as Badouel et al. (1990) took them, or lines (Pandzic et al. 1995) with
// width = frame.width(). REQUIRES: width, height >= 1.
struct Blocks {
  geometry::Rect frame;
  int width = 16, height = 16;

  TaskGrid grid() const;
  geometry::Rect block(std::uint32_t task) const;
};

}  // namespace delray::loadbalance
