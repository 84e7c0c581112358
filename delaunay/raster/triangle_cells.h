// The cells of a grid whose centres lie in a triangle, and the heights there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "delaunay/predicates.h"
#include "delaunay/terrain_raster.h"

namespace delray::delaunay::internal {

// A triangle, counterclockwise, from its lexicographically lowest corner on, so that it is the same
// one however its corners were numbered. Its border is a part of it.
class HeightTriangle {
 public:
  explicit HeightTriangle(const std::array<glm::dvec3, 3>& corners);

  const glm::dvec3& operator[](std::size_t i) const { return p_[i]; }
  bool contains(const glm::dvec2& q) const;
  // At a place in the triangle: that of a vertex there; on an edge that between its ends; between
  // the least and the highest of the corners. Rounded, but the same for all triangles that have the
  // place on their border.
  double height(const glm::dvec2& q) const;
  // As above, for a place that is known to be on no edge.
  double height_within(const glm::dvec2& q) const;

 private:
  std::array<glm::dvec3, 3> p_;
  double area_, low_, high_;
};

// Columns [first, last) of a row.
struct CellRun {
  std::uint64_t row, first, last;
};

// Calls f(run, within) for each row in which the triangle has centres; `within`: whether those but
// the first and the last one of the run are certainly on no edge. The centres of a row that lie in
// a convex set are neighbours: the ends are searched for from where divisions say that the edges
// are, with exact tests.
template <class F>
void for_cells(const RasterGrid& grid, const HeightTriangle& triangle, F&& f);

// Whether a triangle may have a centre in it: most of fine points have none, which this tells in a
// few operations. Differences in cells have
// errors of 2^-13 at most where coordinates are below 2^36 cells: `kSlack` is above.
inline bool may_have_centres(const RasterGrid& grid, const glm::dvec3& a, const glm::dvec3& b,
                             const glm::dvec3& c) {
  constexpr double kSlack = 0x1p-10, kFar = 0x1p36;
  const double west = std::min({a.x, b.x, c.x}), east = std::max({a.x, b.x, c.x});
  const double south = std::min({a.y, b.y, c.y}), north = std::max({a.y, b.y, c.y});
  const double reach = kFar * grid.cell;
  if (!(-west < reach && east < reach && -south < reach && north < reach)) return true;
  const double scale = 1 / grid.cell;
  const auto none_between = [](double low, double high) {
    return std::floor(high - 0.5 + kSlack) < low - 0.5 - kSlack;
  };
  return !none_between((west - grid.west) * scale, (east - grid.west) * scale) &&
         !none_between((grid.north - north) * scale, (grid.north - south) * scale);
}

// The first column or row whose centre is at least x, of n with centres at(i), which ascend.
template <class At>
std::uint64_t first_centre(double x, double guess, std::uint64_t n, At&& at) {
  const auto limit = static_cast<double>(n);
  auto i = static_cast<std::uint64_t>(guess > 0 ? (guess < limit ? guess : limit) : 0);
  while (i > 0 && at(i - 1) >= x) --i;
  while (i < n && at(i) < x) ++i;
  return i;
}

template <class F>
void for_cells(const RasterGrid& grid, const HeightTriangle& t, F&& f) {
  const double low = std::min({t[0].y, t[1].y, t[2].y}), high = std::max({t[0].y, t[1].y, t[2].y});
  // Where divisions are not good for a cell, all of the row is tried.
  constexpr double kFar = 0x1p40;
  const double reach = std::max({std::abs(t[0].x), std::abs(t[1].x), std::abs(t[2].x)});
  const bool far = reach > kFar * grid.cell;
  const double west = t[0].x, east = std::max({t[0].x, t[1].x, t[2].x});  // the first is lowest
  const auto minus_y = [&](std::uint64_t row) { return -grid.y(row); };
  const auto x = [&](std::uint64_t column) { return grid.x(column); };
  const auto column_of = [&](double at) { return (at - grid.west) / grid.cell - 0.5; };
  const std::uint64_t left = first_centre(west, column_of(west), grid.columns, x);
  if (left == grid.columns || grid.x(left) > east) return;  // most triangles of fine points
  for (std::uint64_t row =
           first_centre(-high, (grid.north - high) / grid.cell - 0.5, grid.rows, minus_y);
       row < grid.rows && grid.y(row) >= low; ++row) {
    const double y = grid.y(row);
    // Where the edges cross the row; a level edge lies in it as a whole.
    double first = east, last = west;
    bool level = false;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 &a = t[static_cast<std::size_t>(i)],
                       &b = t[static_cast<std::size_t>((i + 1) % 3)];
      if ((a.y < y && b.y < y) || (a.y > y && b.y > y)) continue;
      level |= a.y == b.y;
      const double part = a.y == b.y ? 0.0 : (y - a.y) / (b.y - a.y);
      const double at = a.x + part * (b.x - a.x);
      first = std::min({first, at, a.y == b.y ? b.x : at});
      last = std::max({last, at, a.y == b.y ? b.x : at});
    }
    if (far) first = west, last = east;
    first = std::clamp(first, west, east);
    last = std::clamp(last, west, east);
    const auto inside = [&](std::uint64_t column) { return t.contains({grid.x(column), y}); };
    std::uint64_t begin = first_centre(first, column_of(first), grid.columns, x);
    std::uint64_t end = first_centre(last, column_of(last), grid.columns, x);
    // One more on either side, as the division is rounded; then as far as it goes.
    if (begin > 0) --begin;
    if (end < grid.columns) ++end;
    while (begin < end && !inside(begin)) ++begin;
    if (begin == end) continue;
    while (begin > 0 && inside(begin - 1)) --begin;
    while (!inside(end - 1)) --end;
    while (end < grid.columns && inside(end)) ++end;
    f(CellRun{row, begin, end}, !level);
  }
}

}  // namespace delray::delaunay::internal
