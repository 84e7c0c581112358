#include "delaunay/internal/cell_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "delaunay/conflict.h"
#include "delaunay/internal/finite_points.h"

namespace delray::delaunay::internal {
namespace {

// A cell number above a row, so that one comparison orders both.
using Entry = std::uint64_t;

constexpr std::uint32_t cell_of(Entry entry) { return static_cast<std::uint32_t>(entry >> 32); }
constexpr std::uint32_t row_of(Entry entry) { return static_cast<std::uint32_t>(entry); }

// Sorts by cell, keeping the order of rows within one: least significant digit first.
void radix_sort(Array<Entry>& entries) {
  constexpr int kDigitBits = 8, kDigits = 4;
  constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
  // Below this, counting the digits takes longer than comparing.
  constexpr std::size_t kSmall = 256;
  const std::size_t n = entries.size();
  if (n < kSmall) {
    std::sort(entries.data(), entries.data() + n);
    return;
  }
  std::array<std::array<std::uint32_t, kValues>, kDigits> count{};
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t cell = cell_of(entries[i]);
    for (int digit = 0; digit < kDigits; ++digit) {
      ++count[digit][(cell >> (digit * kDigitBits)) & (kValues - 1)];
    }
  }
  Array<Entry> other(n);
  for (int digit = 0; digit < kDigits; ++digit) {
    auto& next = count[digit];
    if (std::ranges::find(next, n) != next.end()) continue;  // all have the same digit
    std::exclusive_scan(next.begin(), next.end(), next.begin(), std::uint32_t{0});
    const int shift = 32 + digit * kDigitBits;
    for (std::size_t i = 0; i < n; ++i) {
      other[next[(entries[i] >> shift) & (kValues - 1)]++] = entries[i];
    }
    std::swap(entries, other);
  }
}

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
  radix_sort(entries);
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

std::size_t order_cell(const Rows& all) {
  const std::size_t n = all.points.size();
  std::vector<std::pair<glm::dvec2, std::uint32_t>> sorted(n);
  for (std::size_t i = 0; i < n; ++i) sorted[i] = {all.points[i], all.rows[i]};
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.first == b.first ? a.second < b.second : lexicographically_less(a.first, b.first);
  });
  const auto end = std::unique(sorted.begin(), sorted.end(),
                               [](const auto& a, const auto& b) { return a.first == b.first; });
  const auto kept = static_cast<std::size_t>(end - sorted.begin());
  for (std::size_t i = 0; i < kept; ++i) std::tie(all.points[i], all.rows[i]) = sorted[i];
  if (kept <= kSmallCell) return kept;
  return order_by_grid({all.points.first(kept), all.rows.first(kept)});
}

}  // namespace

CellOrder cell_order(PointView<double> points) {
  const std::size_t n = points.size();
  CellOrder order;
  if (n == 0) return order;
  order.box = finite_box(points);
  const CellGrid grid(order.box);
  Array<Entry> entries(n);
  for (std::size_t row = 0; row < n; ++row) {
    entries[row] = Entry{grid.number(point_at(points, row))} << 32 | row;
  }
  radix_sort(entries);

  order.points = Array<glm::dvec2>(n);
  order.rows = Array<std::uint32_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    order.rows[i] = row_of(entries[i]);
    order.points[i] = point_at(points, order.rows[i]);
  }
  std::size_t kept = 0;
  for (std::size_t first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && cell_of(entries[last]) == cell_of(entries[first]);) ++last;
    const std::size_t count = last - first;
    const std::size_t left =
        count == 1 ? 1 : order_cell({{&order.points[first], count}, {&order.rows[first], count}});
    if (kept != first) {
      std::copy_n(&order.points[first], left, &order.points[kept]);
      std::copy_n(&order.rows[first], left, &order.rows[kept]);
    }
    kept += left;
  }
  order.points.shrink(kept);
  order.rows.shrink(kept);
  return order;
}

}  // namespace delray::delaunay::internal
