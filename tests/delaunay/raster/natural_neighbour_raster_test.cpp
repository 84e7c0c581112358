#include "delaunay/terrain_raster.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include "delaunay/generate.h"
#include "delaunay/interpolate.h"
#include "delaunay/query.h"
#include "parallel/arena.h"
#include "tests/delaunay/pieces_in_memory.h"

namespace delray::delaunay {
namespace {

constexpr float kEmptyCell = -9999;
using Random = std::mt19937_64;

// Row by row.
std::vector<float> rows_of_cells(const TerrainRaster& raster) {
  constexpr std::uint64_t kBlock = TerrainRaster::kBlock;
  const RasterGrid& grid = raster.grid();
  std::vector<float> all(grid.columns * grid.rows), block(kBlock * kBlock);
  for (std::uint64_t row = 0; row < grid.rows; ++row) {
    for (std::uint64_t column = 0; column < grid.columns; column += kBlock) {
      raster.read_block(column / kBlock, row / kBlock, kEmptyCell, block);
      const std::uint64_t count = std::min(kBlock, grid.columns - column);
      std::copy_n(block.data() + row % kBlock * kBlock, count,
                  all.data() + row * grid.columns + column);
    }
  }
  return all;
}

PointCloud wavy_points(std::string_view kind, std::size_t n, std::uint64_t seed) {
  PointCloud cloud = generate_points(kind, n, 2, seed);
  cloud.has_z = true;
  for (glm::dvec3& p : cloud.positions) p.z = std::round(100 * std::sin(3 * p.x) * p.y) / 8;
  return cloud;
}

// Most of the centres of its cells are in the box, some are beyond.
RasterGrid grid_over(const PointCloud& cloud, int cells) {
  geometry::Box3d box;
  for (const glm::dvec3& p : cloud.positions) box.include(p);
  const double cell = std::max(box.size().x, box.size().y) / cells;
  box.low -= cell;
  box.high += cell;
  return raster_grid(box, cell);
}

std::vector<float> filled_in_memory(const PointCloud& cloud, const RasterGrid& grid) {
  TerrainRaster raster(grid);
  fill_natural_neighbours(view(cloud.positions), triangulate(view(cloud.positions)).triangulation,
                          raster);
  return rows_of_cells(raster);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Turns corners round and exchanges triangles, without changing what they are.
void shuffle_triangles(PieceMesh& piece, Random& random) {
  std::vector<std::array<std::uint32_t, 3>> triangles(piece.simplices.size() / 3);
  std::memcpy(triangles.data(), piece.simplices.data(), piece.simplices.size() * 4);
  for (auto& t : triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  std::ranges::shuffle(triangles, random);
  std::memcpy(piece.simplices.data(), triangles.data(), piece.simplices.size() * 4);
}

TEST(NaturalNeighbourRaster, AgreesWithQueries) {
  for (const PointGenerator& kind : point_generators()) {
    SCOPED_TRACE(kind.name);
    const PointCloud cloud = wavy_points(kind.name, 250, 4);
    const Triangulation whole = triangulate(view(cloud.positions)).triangulation;
    if (whole.size() == 0) continue;
    const RasterGrid grid = grid_over(cloud, 40);
    const std::vector<float> cells = filled_in_memory(cloud, grid);
    const Query query(view(cloud.positions), whole);
    std::vector<double> heights;
    for (const glm::dvec3& p : cloud.positions) heights.push_back(p.z);
    for (std::uint64_t row = 0; row < grid.rows; ++row) {
      for (std::uint64_t column = 0; column < grid.columns; ++column) {
        const auto expected =
            interpolate_natural_neighbour(query, heights, {grid.x(column), grid.y(row), 0});
        EXPECT_EQ(cells[row * grid.columns + column],
                  expected ? static_cast<float>(*expected) : kEmptyCell)
            << column << ", " << row;
      }
    }
  }
}

TEST(NaturalNeighbourRaster, IsTheSameForAllPieces) {
  for (const std::string_view kind : {"grid", "uniform", "cluster", "arc", "gauss"}) {
    Random random(5);
    PointCloud cloud = wavy_points(kind, 900, 6);
    if (kind == "grid") {  // centres of cells are vertices, on edges and on circles
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        cloud.positions[i] = {double(i % 30) * 4, double(i / 30) * 4, double(random() % 997) / 7};
      }
    }
    for (const int fineness : {20, 150}) {
      const RasterGrid grid =
          kind == "grid" ? RasterGrid{-2.5, 118.5, 1, 122, 122} : grid_over(cloud, fineness);
      const std::vector<float> expected = filled_in_memory(cloud, grid);
      EXPECT_GT(std::ranges::count_if(expected, [](float z) { return z != kEmptyCell; }), 10);
      for (const std::size_t pieces : {1U, 2U, 7U, 64U, 2000U}) {
        SCOPED_TRACE(std::string(kind) + ", " + std::to_string(pieces) + " pieces, " +
                     std::to_string(fineness));
        std::vector<PieceMesh> some = tests::in_pieces(cloud, 2, pieces);
        std::ranges::shuffle(some, random);
        for (PieceMesh& piece : some) shuffle_triangles(piece, random);
        TerrainRaster raster(grid);
        NaturalNeighbourRaster smooth(raster), other(raster);
        std::atomic<std::size_t> next{0};
        {
          std::vector<std::jthread> threads;
          for (int i = 0; i < 3; ++i) {
            threads.emplace_back([&, i] {
              for (std::size_t at = 0; (at = next++) < some.size();) {
                (i == 0 ? other : smooth).take({2, at, some[at].points, some[at].simplices});
              }
            });
          }
        }
        smooth.add_waiting(other.give_waiting());
        smooth.finish();
        EXPECT_TRUE(same_bits(rows_of_cells(raster), expected));
      }
    }
  }
}

// What waits is put together again and again, and most of it goes.
TEST(NaturalNeighbourRaster, WaitsForNothingThatHasCome) {
  const PointCloud cloud = wavy_points("uniform", 60000, 3);
  const RasterGrid grid = grid_over(cloud, 100);
  TerrainRaster raster(grid);
  NaturalNeighbourRaster smooth(raster);
  std::vector<PieceMesh> pieces = tests::in_pieces(cloud, 2, 3000);
  std::size_t came = 0;
  for (const PieceMesh& piece : pieces) {
    smooth.take({2, came++, piece.points, piece.simplices});
  }
  const std::vector<WaitingTriangle> waiting = smooth.give_waiting();
  EXPECT_LT(waiting.size(), std::size_t{1} << 16);  // of 120 000 triangles, all at borders
  smooth.add_waiting(waiting);
  smooth.finish();
  EXPECT_TRUE(same_bits(rows_of_cells(raster), filled_in_memory(cloud, grid)));
}

TEST(NaturalNeighbourRaster, RowsHave64Bits) {
  const PointCloud cloud = wavy_points("uniform", 400, 3);
  const RasterGrid grid = grid_over(cloud, 60);
  TerrainRaster raster(grid);
  NaturalNeighbourRaster smooth(raster);
  std::size_t came = 0;
  for (PieceMesh piece : tests::in_pieces(cloud, 2, 9)) {
    for (RowPoint& point : piece.points) point.row += (std::uint64_t{1} << 32) - 200;
    smooth.take({2, came++, piece.points, piece.simplices});
  }
  smooth.finish();
  EXPECT_TRUE(same_bits(rows_of_cells(raster), filled_in_memory(cloud, grid)));
}

TEST(NaturalNeighbourRaster, DoesNotDependOnThreadsNorOrder) {
  const PointCloud cloud = wavy_points("uniform", 9000, 8);
  PieceMesh all = tests::in_pieces(cloud, 2, 1).front();
  const RasterGrid grid = grid_over(cloud, 200);
  std::vector<float> expected;
  parallel::Arena(1).execute([&] { expected = filled_in_memory(cloud, grid); });
  Random random(1);
  shuffle_triangles(all, random);
  Triangulation shuffled;
  for (const std::uint32_t v : all.simplices) {
    shuffled.vertices.push_back(static_cast<std::uint32_t>(all.points[v].row));
  }
  TerrainRaster raster(grid);
  parallel::AllowThreads allowed(5);
  parallel::Arena(5).execute(
      [&] { fill_natural_neighbours(view(cloud.positions), shuffled, raster); });
  EXPECT_TRUE(same_bits(rows_of_cells(raster), expected));
}

TEST(NaturalNeighbourRaster, OfNothingIsEmpty) {
  TerrainRaster raster(RasterGrid{0, 4, 1, 4, 4});
  NaturalNeighbourRaster smooth(raster);
  smooth.take({2, 0, {}, {}});
  smooth.finish();
  EXPECT_EQ(rows_of_cells(raster), std::vector<float>(16, kEmptyCell));
}

}  // namespace
}  // namespace delray::delaunay
