// Converts points to CGAL's own type before the clock starts, and times the insertion alone.
#include "bench/peers/cgald.h"

#include <CGAL/Delaunay_triangulation.h>
#include <CGAL/Epick_d.h>

#include <chrono>
#include <map>
#include <vector>

namespace delray::bench {

using KernelOf4 = CGAL::Epick_d<CGAL::Dimension_tag<4>>;
using PointOf4 = KernelOf4::Point_d;

static std::vector<PointOf4> convert4(std::span<const double> coordinates) {
  std::vector<PointOf4> input;
  for (std::size_t i = 0; i + 4 <= coordinates.size(); i += 4) {
    input.emplace_back(coordinates.begin() + i, coordinates.begin() + i + 4);
  }
  return input;
}

double seconds_of_cgal4(std::span<const double> coordinates) {
  const std::vector<PointOf4> input = convert4(coordinates);
  const auto start = std::chrono::steady_clock::now();
  CGAL::Delaunay_triangulation<KernelOf4> triangulation(4);
  triangulation.insert(input.begin(), input.end());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

delaunay::Triangulation triangulate_with_cgal4(std::span<const double> coordinates) {
  const std::vector<PointOf4> input = convert4(coordinates);
  CGAL::Delaunay_triangulation<KernelOf4> triangulation(4);
  triangulation.insert(input.begin(), input.end());
  std::map<std::vector<double>, std::uint32_t> rows;
  for (std::uint32_t row = 0; row < input.size(); ++row) {
    rows.emplace(
        std::vector<double>(coordinates.begin() + 4 * row, coordinates.begin() + 4 * row + 4), row);
  }
  delaunay::Triangulation result;
  result.dim = 4;
  result.distinct = triangulation.number_of_vertices();
  if (triangulation.current_dimension() < 4) return result;
  for (auto cell = triangulation.full_cells_begin(); cell != triangulation.full_cells_end();
       ++cell) {
    if (triangulation.is_infinite(cell)) {
      ++result.hull_facets;
      continue;
    }
    for (int k = 0; k <= 4; ++k) {
      const PointOf4& p = cell->vertex(k)->point();
      result.vertices.push_back(rows.at({p[0], p[1], p[2], p[3]}));
    }
  }
  return result;
}

}  // namespace delray::bench
