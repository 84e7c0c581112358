// Spreads boxes over the cost grid: each box adds an even share of its cost to the cells that it
// overlaps, and the cost that a straight cut through it would duplicate to the edges between them
// (Mueller 1995). O(boxes + cells touched).
#include "loadbalance/costs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <utility>

#include "comm/collectives.h"

namespace delray::loadbalance {
namespace {

using geometry::Rect;

// Cells and boxes for each part of a partition: of pieces much larger than a thousandth of its
// share a part gets some too many or too few.
constexpr std::int64_t kPiecesPerPart = 1000;

// Boxes that one rank gathers: with more parts each has fewer of them. A hundred boxes for each of
// a thousand parts still leave cuts within a tenth of a part's side.
constexpr std::int64_t kMostBoxes = std::int64_t{1} << 17;

// Primitives of a box, at most. Ranks spend time on each box, and with larger ones gain none.
constexpr std::uint64_t kLargestBox = 1024;

// The first pixel of cell i of `cells` over `pixels` pixels.
int border(int i, int cells, int pixels) {
  return static_cast<int>(std::int64_t{i} * pixels / cells);
}

// The last cell that begins at or before pixel x.
int cell_of(int x, int cells, int pixels) {
  return static_cast<int>(((std::int64_t{x} + 1) * cells - 1) / pixels);
}

void add(Costs& costs, const WeightedBox& box) {
  const Rect visible = geometry::intersection(box.box, costs.frame);
  if (visible.empty()) return;
  const Rect cells = costs.cells_of(visible);
  const double share = box.cost / static_cast<double>(cells.area());
  const double right = box.cost / cells.height(), down = box.cost / cells.width();
  for (int j = cells.y0; j < cells.y1; ++j) {
    const std::size_t row = static_cast<std::size_t>(j) * static_cast<std::size_t>(costs.columns);
    for (int i = cells.x0; i < cells.x1; ++i) {
      const std::size_t k = row + static_cast<std::size_t>(i);
      costs.cells[k] += share;
      if (i + 1 < cells.x1) costs.cross_right[k] += right;
      if (j + 1 < cells.y1) costs.cross_down[k] += down;
    }
  }
}

}  // namespace

Rect Costs::cell(int i, int j) const {
  return {frame.x0 + border(i, columns, frame.width()), frame.y0 + border(j, rows, frame.height()),
          frame.x0 + border(i + 1, columns, frame.width()),
          frame.y0 + border(j + 1, rows, frame.height())};
}

Rect Costs::cells_of(const Rect& pixels) const {
  if (pixels.empty()) return {};
  return {cell_of(pixels.x0 - frame.x0, columns, frame.width()),
          cell_of(pixels.y0 - frame.y0, rows, frame.height()),
          cell_of(pixels.x1 - 1 - frame.x0, columns, frame.width()) + 1,
          cell_of(pixels.y1 - 1 - frame.y0, rows, frame.height()) + 1};
}

Costs make_costs(Rect frame, int columns, int rows, std::vector<WeightedBox> boxes) {
  if (columns < 1 || rows < 1) throw std::invalid_argument("a grid of costs has at least one cell");
  Costs costs;
  costs.frame = frame;
  costs.columns = std::clamp(columns, 1, std::max(1, frame.width()));
  costs.rows = std::clamp(rows, 1, std::max(1, frame.height()));
  const std::size_t size =
      static_cast<std::size_t>(costs.columns) * static_cast<std::size_t>(costs.rows);
  costs.cells.resize(size);
  costs.cross_right.resize(size);
  costs.cross_down.resize(size);
  costs.boxes = std::move(boxes);
  for (const WeightedBox& box : costs.boxes) {
    if (!(std::isfinite(box.cost) && 0 <= box.setup && box.setup <= box.cost))
      throw std::invalid_argument("a cost is negative, not finite or less than its setup");
    add(costs, box);
  }
  return costs;
}

int cost_cell_side(Rect frame, int parts) {
  if (parts < 1) throw std::invalid_argument("a partition has at least one part");
  int side = 16;
  while (side > 2 && std::int64_t{side} * side * kPiecesPerPart * parts > frame.area()) side /= 2;
  return side;
}

int primitives_per_box(std::uint64_t primitives, int parts) {
  if (parts < 1) throw std::invalid_argument("a partition has at least one part");
  const auto pieces = static_cast<std::uint64_t>(std::min(kPiecesPerPart * parts, kMostBoxes));
  return static_cast<int>(std::clamp<std::uint64_t>(primitives / pieces, 1, kLargestBox));
}

std::vector<WeightedBox> gather_boxes(std::span<const WeightedBox> boxes,
                                      comm::Communicator& communicator) {
  std::vector<WeightedBox> all;
  const std::vector<comm::Buffer> gathered = comm::gather(communicator, 0, comm::Buffer::of(boxes));
  std::size_t count = 0;
  for (const comm::Buffer& from : gathered) count += from.size() / sizeof(WeightedBox);
  all.reserve(count);
  for (const comm::Buffer& from : gathered) {
    const auto some = from.as<WeightedBox>();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace delray::loadbalance
