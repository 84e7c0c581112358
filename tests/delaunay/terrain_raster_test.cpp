#include "delaunay/terrain_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <thread>

#include "delaunay/generate.h"
#include "delaunay/interpolate.h"
#include "delaunay/query.h"
#include "parallel/arena.h"
#include "tests/delaunay/pieces_in_memory.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

constexpr float kNoData = -9999;
using Random = std::mt19937_64;

std::vector<float> cells_of(const TerrainRaster& raster) {
  constexpr std::uint64_t kBlock = TerrainRaster::kBlock;
  std::vector<float> all, block(kBlock * kBlock);
  for (std::uint64_t row = 0; row < raster.block_rows(); ++row) {
    for (std::uint64_t column = 0; column < raster.block_columns(); ++column) {
      raster.read_block(column, row, kNoData, block);
      all.insert(all.end(), block.begin(), block.end());
    }
  }
  return all;
}

float cell(const TerrainRaster& raster, std::uint64_t column, std::uint64_t row) {
  constexpr std::uint64_t kBlock = TerrainRaster::kBlock;
  std::vector<float> block(kBlock * kBlock);
  raster.read_block(column / kBlock, row / kBlock, kNoData, block);
  return block[row % kBlock * kBlock + column % kBlock];
}

PointCloud with_heights(const std::vector<glm::dvec3>& positions) {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = positions;
  return cloud;
}

PointCloud terrain(std::string_view kind, std::size_t n, std::uint64_t seed) {
  PointCloud cloud = generate_points(kind, n, 2, seed);
  cloud.has_z = true;
  for (glm::dvec3& p : cloud.positions) p.z = std::round(100 * std::sin(3 * p.x) * p.y) / 8;
  return cloud;
}

Triangulation triangulated(const PointCloud& cloud) {
  return triangulate(view(cloud.positions)).triangulation;
}

geometry::Box3d box_of(const PointCloud& cloud) {
  geometry::Box3d box;
  for (const glm::dvec3& p : cloud.positions) box.include(p);
  return box;
}

// Every cell has what a query at its centre says: nothing outside of the triangulation, the same
// within, but for rounding.
TEST(TerrainRaster, AgreesWithQueries) {
  for (const PointGenerator& kind : point_generators()) {
    SCOPED_TRACE(kind.name);
    const PointCloud cloud = terrain(kind.name, 300, 4);
    const Triangulation whole = triangulated(cloud);
    if (whole.size() == 0) continue;
    geometry::Box3d box = box_of(cloud);
    const double cell_size = std::max(box.size().x, box.size().y) / 60;
    box.low -= cell_size * 2;
    TerrainRaster raster(raster_grid(box, cell_size));
    give_runs(view(cloud.positions), whole, 50, raster);
    const Query query(view(cloud.positions), whole);
    std::vector<double> heights;
    for (const glm::dvec3& p : cloud.positions) heights.push_back(p.z);
    const RasterGrid& grid = raster.grid();
    ASSERT_EQ(raster.block_columns() * raster.block_rows(), 1U);
    const std::vector<float> block = cells_of(raster);
    std::vector<float> row_by_row;
    for (std::uint64_t row = 0; row < grid.rows; ++row) {
      const auto first = block.begin() + static_cast<std::ptrdiff_t>(row * TerrainRaster::kBlock);
      row_by_row.insert(row_by_row.end(), first, first + static_cast<std::ptrdiff_t>(grid.columns));
    }
    for (std::uint64_t row = 0; row < grid.rows; ++row) {
      for (std::uint64_t column = 0; column < grid.columns; ++column) {
        const auto expected = interpolate_linear(query, heights, {grid.x(column), grid.y(row), 0});
        const float got = row_by_row[row * grid.columns + column];
        EXPECT_EQ(got != kNoData, expected.has_value()) << column << ", " << row;
        if (expected) {  // both are rounded, heights to floats
          EXPECT_NEAR(got, *expected, 1e-3 + 1e-6 * std::abs(*expected)) << column << ", " << row;
        }
      }
    }
  }
}

// Centres on vertices, edges and the border: whatever the pieces, threads and blocks in memory, and
// wherever corners of a triangle begin, the raster is the same to the bit.
TEST(TerrainRaster, IsTheSameForAllPieces) {
  Random random(5);
  for (const std::string_view kind : {"grid", "uniform", "cluster", "arc"}) {
    SCOPED_TRACE(kind);
    PointCloud cloud = terrain(kind, 900, 6);
    if (kind == "grid") {  // whole numbers, so that centres of cells are vertices and on edges
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        cloud.positions[i] = {double(i % 30) * 20, double(i / 30) * 20, double(random() % 997) / 7};
      }
    }
    const Triangulation whole = triangulated(cloud);
    const geometry::Box3d box = box_of(cloud);
    const RasterGrid grid = kind == "grid"
                                ? RasterGrid{-10.5, 590.5, 1, 601, 601}
                                : raster_grid(box, std::max(box.size().x, box.size().y) / 500);
    TerrainRaster one(grid);
    give_runs(view(cloud.positions), whole, 1u << 30, one);
    const std::vector<float> expected = cells_of(one);
    EXPECT_GT(std::ranges::count_if(expected, [](float z) { return z != kNoData; }), 1000);
    for (const std::size_t pieces : {1U, 7U, 64U}) {
      std::vector<PieceMesh> some = tests::in_pieces(cloud, 2, pieces);
      std::ranges::shuffle(some, random);
      for (PieceMesh& piece : some) {
        for (std::size_t i = 0; i < piece.simplices.size(); i += 3) {
          std::rotate(piece.simplices.begin() + static_cast<std::ptrdiff_t>(i),
                      piece.simplices.begin() + static_cast<std::ptrdiff_t>(i + random() % 3),
                      piece.simplices.begin() + static_cast<std::ptrdiff_t>(i + 3));
        }
      }
      for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{1} << 30}) {
        TerrainRaster raster(grid, {memory, testing::TempDir()});
        std::atomic<std::size_t> next{0};
        {
          std::vector<std::jthread> threads;
          for (int i = 0; i < 3; ++i) {
            threads.emplace_back([&] {
              for (std::size_t at = 0; (at = next++) < some.size();) {
                raster.take({2, at, some[at].points, some[at].simplices});
              }
            });
          }
        }
        const std::vector<float> got = cells_of(raster);
        EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)), 0)
            << pieces << " pieces, " << memory << " bytes";
      }
    }
  }
}

TEST(TerrainRaster, TakesHeightsOfVerticesAndEdges) {
  const PointCloud cloud =
      with_heights({{0.5, 0.5, 1}, {4.5, 0.5, 2}, {0.5, 4.5, 4}, {4.5, 4.5, 8}});
  TerrainRaster raster(RasterGrid{0, 5, 1, 6, 5});
  give_runs(view(cloud.positions), triangulated(cloud), 1, raster);
  EXPECT_EQ(cell(raster, 0, 4), 1);
  EXPECT_EQ(cell(raster, 4, 4), 2);
  EXPECT_EQ(cell(raster, 0, 0), 4);
  EXPECT_EQ(cell(raster, 4, 0), 8);
  EXPECT_EQ(cell(raster, 2, 4), 1.5F);
  EXPECT_EQ(cell(raster, 0, 2), 2.5F);
  EXPECT_EQ(cell(raster, 5, 4), kNoData);
}

TEST(TerrainRaster, KeepsHeightsThatAreNoDataApart) {
  const PointCloud cloud = with_heights({{0, 0, kNoData}, {4, 0, kNoData}, {0, 4, kNoData}});
  TerrainRaster raster(RasterGrid{0, 4, 1, 4, 4});
  give_runs(view(cloud.positions), triangulated(cloud), 1, raster);
  EXPECT_EQ(cell(raster, 0, 3), std::nextafter(kNoData, -INFINITY));
  EXPECT_EQ(cell(raster, 3, 0), kNoData);
}

TEST(TerrainRaster, GridsCoverTheirBoxes) {
  geometry::Box3d box;
  box.include({10.2, -3.7, 0});
  box.include({13, 5, 1});
  const RasterGrid grid = raster_grid(box, 0.5);
  EXPECT_EQ(grid.west, 10);
  EXPECT_EQ(grid.north, 5);
  EXPECT_EQ(grid.columns, 6U);
  EXPECT_EQ(grid.rows, 18U);
  const RasterGrid within = raster_grid_within(box, 0.5);
  EXPECT_EQ(within.west, 10.2);
  EXPECT_EQ(within.columns, 6U);
  EXPECT_THROW(raster_grid(box, 1e-30), std::invalid_argument);
  EXPECT_THROW(raster_grid(box, 1e-10), std::invalid_argument);
  box.include({1e200, 0, 0});
  EXPECT_THROW(raster_grid(box, 1), std::invalid_argument);
}

// A box that a few triangles reach far out of; slivers and huge coordinates.
TEST(TerrainRaster, TakesTrianglesFarLargerThanItself) {
  const PointCloud cloud =
      with_heights({{-1e15, -3e14, 5}, {2e15, 1, 5}, {1e3, 1e16, 5}, {0.1, 0.2, 5}, {0.3, 0.1, 5}});
  TerrainRaster raster(RasterGrid{-20, 20, 0.5, 80, 80});
  give_runs(view(cloud.positions), triangulated(cloud), 1, raster);
  for (const std::uint64_t at : {0U, 40U, 79U}) EXPECT_EQ(cell(raster, at, at), 5) << at;
}

}  // namespace
}  // namespace delray::delaunay
