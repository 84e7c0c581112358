// The costs that a partition is cut by: a grid of costs and boxes with weights, never primitives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "geometry/rect.h"

namespace delray::loadbalance {

// A group of primitives (rays, points) and what it costs; the box is in pixels and may reach
// outside the frame. A tile of the last frame and the seconds that it took is one, too.
struct WeightedBox {
  geometry::Rect box;
  double cost = 0;   // for one rank that does all of it
  double setup = 0;  // the part of `cost` that each owner pays again who gets some of the group
  std::uint64_t primitives = 1;
  bool operator==(const WeightedBox&) const = default;
};

// Costs over a frame, gathered from boxes or measured. Cell (i, j) of the grid covers the pixels
//   [x0 + i*width/columns, x0 + (i+1)*width/columns) x [y0 + j*height/rows, ...) of `frame`,
// divisions rounded down.
struct Costs {
  geometry::Rect frame;
  int columns = 0, rows = 0;
  std::vector<double> cells;  // rows * columns, row-major
  // Cost that crosses the edge between cells (i, j) and (i+1, j); last column 0. A box shares its
  // cost among the edges of a column that it crosses, so that a straight cut costs it once.
  std::vector<double> cross_right;
  std::vector<double> cross_down;  // ... (i, j) and (i, j+1); last row 0
  std::vector<WeightedBox> boxes;

  geometry::Rect cell(int i, int j) const;  // its pixels
  // The cells that some pixels overlap; empty without pixels. REQUIRES: `pixels` lies in the frame.
  geometry::Rect cells_of(const geometry::Rect& pixels) const;
};

// Each box adds its cost, split evenly, to the cells that it overlaps (Mueller 1995), so that it
// counts once; boxes outside the frame add nothing. The boxes are kept: many of them are best moved
// in, since a copy that large is new memory in every frame. A frame with fewer pixels
// than `columns` or `rows` gets a grid of so many cells, at least one. O(boxes + cells touched).
// Throws std::invalid_argument unless columns, rows >= 1, costs are finite, 0 <= setup <= cost.
Costs make_costs(geometry::Rect frame, int columns, int rows, std::vector<WeightedBox> boxes);

// A side of square cells, in pixels, that leaves partitions into so many parts fine cuts: about a
// thousand cells for each part. A power of two from 2 to 16. REQUIRES: parts >= 1.
int cost_cell_side(geometry::Rect frame, int parts);

// The number of primitives to take together in a box, given how many are in the frame: about a
// thousand boxes for each part, so that a small scene gives each primitive its own, but no more
// than one rank can look at in a few milliseconds, however many parts there are. From 1 to 1024.
// REQUIRES: parts >= 1.
int primitives_per_box(std::uint64_t primitives, int parts);

// All ranks' boxes strung together by rank, on rank 0; none elsewhere. Collective: every box
// travels once, which costs less than sums of grids over many ranks would.
std::vector<WeightedBox> gather_boxes(std::span<const WeightedBox> boxes,
                                      comm::Communicator& communicator);

}  // namespace delray::loadbalance
