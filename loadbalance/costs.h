// What a partition knows of the work: a grid of costs and boxes with weights, never primitives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/rect.h"

namespace delray::loadbalance {

// A group of primitives (rays, points) and what it costs; the box is in pixels and may reach
// outside the frame.
struct WeightedBox {
  geometry::Rect box;
  double cost = 0;
};

// Costs over a frame, gathered from boxes or measured. Cell (i, j) of the grid covers the pixels
//   [x0 + i*width/columns, x0 + (i+1)*width/columns) x [y0 + j*height/rows, ...) of `frame`.
struct Costs {
  geometry::Rect frame;
  int columns = 0, rows = 0;
  std::vector<double> cells;  // rows * columns, row-major
  std::vector<double>
      cross_right;  // cost crossing the edge between cells (i, j) and (i+1, j); last column 0
  std::vector<double> cross_down;  // ... (i, j) and (i, j+1); last row 0
  std::vector<WeightedBox> boxes;

  geometry::Rect cell(int i, int j) const;  // its pixels
};

// Each box adds its cost, split evenly, to the cells that it overlaps (Mueller 1995), so that it
// counts once; boxes outside the frame add nothing. The boxes are kept. O(boxes + cells touched).
// REQUIRES: columns, rows >= 1; costs finite and >= 0.
Costs make_costs(geometry::Rect frame, int columns, int rows, std::span<const WeightedBox> boxes);

}  // namespace delray::loadbalance
