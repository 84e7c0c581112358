// Natural neighbours at the centres of cells. Sums of weights are rounded in the order in which
// simplices are walked: they are sorted first, so that this depends on the triangulation alone.
#include <algorithm>
#include <array>
#include <vector>

#include "delaunay/interpolate.h"
#include "delaunay/query.h"
#include "delaunay/terrain_raster.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// The same triangles by their rows, each from its lowest row on.
Triangulation sorted_triangles(const Triangulation& triangulation) {
  std::vector<std::array<std::uint32_t, 3>> triangles(triangulation.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::copy_n(triangulation.vertices.data() + 3 * i, 3, triangles[i].begin());
    std::rotate(triangles[i].begin(), std::ranges::min_element(triangles[i]), triangles[i].end());
  }
  std::ranges::sort(triangles);
  Triangulation sorted = triangulation;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::copy_n(triangles[i].begin(), 3, sorted.vertices.data() + 3 * i);
  }
  return sorted;
}

}  // namespace

void fill_natural_neighbours(PointView<double> points, const Triangulation& triangulation,
                             TerrainRaster& raster) {
  if (triangulation.size() == 0) return;
  const Triangulation sorted = sorted_triangles(triangulation);
  const Query query(points, sorted);
  std::vector<double> heights(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = points(i, 2);
  const RasterGrid& grid = raster.grid();
  constexpr std::uint64_t kBlock = TerrainRaster::kBlock;
  // Block by block, so that few of them are in memory at a time.
  for (std::uint64_t block = 0; block < raster.block_columns() * raster.block_rows(); ++block) {
    const std::uint64_t left = block % raster.block_columns() * kBlock;
    const std::uint64_t top = block / raster.block_columns() * kBlock;
    parallel::parallel_for(top, std::min(top + kBlock, grid.rows), 1, [&](std::uint64_t row) {
      for (std::uint64_t column = left; column < std::min(left + kBlock, grid.columns); ++column) {
        const auto height = interpolate_natural_neighbour(
            query, heights, glm::dvec3(grid.x(column), grid.y(row), 0));
        if (height) raster.set(column, row, *height);
      }
    });
  }
}

}  // namespace delray::delaunay
