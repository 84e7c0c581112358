#include "delaunay/internal/cell_order.h"

#include <algorithm>
#include <array>
#include <vector>

#include "delaunay/conflict.h"
#include "delaunay/internal/blocks.h"
#include "delaunay/internal/finite_points.h"
#include "delaunay/internal/radix_sort.h"

namespace delray::delaunay::internal {
namespace {

// A cell number above a row, so that one comparison orders both.
using Entry = std::uint64_t;

constexpr std::uint32_t cell_of(Entry entry) { return static_cast<std::uint32_t>(entry >> 32); }
constexpr std::uint32_t row_of(Entry entry) { return static_cast<std::uint32_t>(entry); }

// Distinct points with their rows, side by side.
struct Rows {
  std::span<glm::dvec2> points;
  std::span<std::uint32_t> rows;
};

// Orders the points of one cell and drops duplicates; returns how many are left.
std::size_t order_cell(const Rows& all);

// Orders a range by a grid of its own.
std::size_t order_by_grid(const Rows& all) {
  const std::size_t n = all.points.size();
  const CellGrid grid(box_of(all.points));
  Array<Entry> entries(n);
  for (std::size_t i = 0; i < n; ++i) {
    entries[i] = Entry{grid.number(all.points[i])} << 32 | i;
  }
  radix_sort(entries, Blocks(n, 1));
  const std::vector<glm::dvec2> points(all.points.begin(), all.points.end());
  const std::vector<std::uint32_t> rows(all.rows.begin(), all.rows.end());
  for (std::size_t i = 0; i < n; ++i) {
    all.points[i] = points[row_of(entries[i])];
    all.rows[i] = rows[row_of(entries[i])];
  }
  std::size_t kept = 0;
  for (std::size_t first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && cell_of(entries[last]) == cell_of(entries[first]);) ++last;
    const std::size_t count = last - first;
    const std::size_t left =
        count == 1 ? 1
                   : order_cell({all.points.subspan(first, count), all.rows.subspan(first, count)});
    std::copy_n(all.points.begin() + first, left, all.points.begin() + kept);
    std::copy_n(all.rows.begin() + first, left, all.rows.begin() + kept);
    kept += left;
  }
  return kept;
}

struct RowPoint {
  glm::dvec2 point;
  std::uint32_t row;
};

std::size_t order_cell(const Rows& all) {
  const std::size_t n = all.points.size();
  // Nearly all cells with more than one point have two or three.
  std::array<RowPoint, kSmallCell> few;
  std::vector<RowPoint> many(n > few.size() ? n : 0);
  const std::span<RowPoint> sorted(n > few.size() ? many.data() : few.data(), n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = {all.points[i], all.rows[i]};
  std::ranges::sort(sorted, [](const RowPoint& a, const RowPoint& b) {
    return a.point == b.point ? a.row < b.row : lexicographically_less(a.point, b.point);
  });
  std::size_t kept = 0;
  for (const RowPoint& p : sorted) {
    if (kept > 0 && all.points[kept - 1] == p.point) continue;
    all.points[kept] = p.point;
    all.rows[kept++] = p.row;
  }
  if (kept <= kSmallCell) return kept;
  return order_by_grid({all.points.first(kept), all.rows.first(kept)});
}

// Fetches the points of entries [first, last), whole cells, to the places from `first` on; returns
// how many are distinct.
std::size_t fetch_cells(const PointView<double>& points, const Array<Entry>& entries,
                        std::size_t first, std::size_t last, CellOrder& order) {
  std::size_t kept = first;
  for (std::size_t next = first; next < last;) {
    const std::uint32_t cell = cell_of(entries[next]);
    std::size_t count = 0;
    do {
      const std::uint32_t row = row_of(entries[next++]);
      order.rows[kept + count] = row;
      order.points[kept + count] = point_at(points, row);
      ++count;
    } while (next < last && cell_of(entries[next]) == cell);
    if (count > 1) count = order_cell({{&order.points[kept], count}, {&order.rows[kept], count}});
    kept += count;
  }
  return kept - first;
}

// The points of all entries; every block fetches the cells that begin in it.
void fetch(const PointView<double>& points, const Array<Entry>& entries, const Blocks& blocks,
           CellOrder& order) {
  const std::size_t n = entries.size();
  order.points = Array<glm::dvec2>(n);
  order.rows = Array<std::uint32_t>(n);
  const auto begin_of_cell = [&](std::size_t i) {
    while (i > 0 && i < n && cell_of(entries[i]) == cell_of(entries[i - 1])) ++i;
    return i;
  };
  struct Range {
    std::size_t first, count;
  };
  std::vector<Range> fetched(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t from, std::size_t to) {
    const std::size_t first = begin_of_cell(from), last = begin_of_cell(to);
    fetched[block] = {first, fetch_cells(points, entries, first, last, order)};
  });
  std::size_t kept = 0;
  for (const auto& [first, count] : fetched) {
    if (kept != first) {
      std::copy_n(order.points.data() + first, count, order.points.data() + kept);
      std::copy_n(order.rows.data() + first, count, order.rows.data() + kept);
    }
    kept += count;
  }
  order.points.shrink(kept);
  order.rows.shrink(kept);
}

}  // namespace

CellOrder cell_order(PointView<double> points, int threads) {
  const std::size_t n = points.size();
  CellOrder order;
  if (n == 0) return order;
  const Blocks blocks(n, threads);
  order.box = finite_box(points, threads);
  const CellGrid grid(order.box);
  Array<Entry> entries(n);
  blocks.for_each([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      entries[row] = Entry{grid.number(point_at(points, row))} << 32 | row;
    }
  });
  radix_sort(entries, blocks);
  fetch(points, entries, blocks, order);
  return order;
}

}  // namespace delray::delaunay::internal
