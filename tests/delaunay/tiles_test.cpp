#include "delaunay/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "comm/threads.h"
#include "delaunay/generate.h"
#include "delaunay/methods.h"
#include "delaunay/triangulate.h"
#include "loadbalance/partition.h"
#include "tests/delaunay/summed_parts.h"

namespace delray::delaunay {
namespace {

using tests::with_rows;

struct Whole : tests::SummedParts {
  std::vector<TileStatistics> tiles;
  int rounds = 0;
};

// Every rank has some of the points: runs of rows, or each so-many-th one.
Whole triangulate_on(int ranks, const std::vector<RowPoint>& points, const TileOptions& options,
                     bool runs) {
  Whole whole;
  std::mutex mutex;
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    const TiledTriangulation part = triangulate_tiles(
        communicator, tests::points_of_rank(points, communicator.rank(), ranks, runs), options);
    const std::lock_guard lock(mutex);
    whole.add(part);
    whole.tiles.insert(whole.tiles.end(), part.tiles.begin(), part.tiles.end());
    whole.rounds = part.rounds;
  });
  return whole;
}

void expect_whole(const std::vector<glm::dvec3>& positions, int dim, int ranks,
                  const TileOptions& given, bool runs) {
  TileOptions options = given;
  options.triangulate.dim = dim;
  Options in_core;
  in_core.dim = dim;
  const Triangulation expected = triangulate(view(positions), in_core).triangulation;
  const Whole got = triangulate_on(ranks, with_rows(positions, 0), options, runs);
  tests::expect_equal(got, expected);
}

TEST(Tiles, GiveTheTriangulationOfAllPoints) {
  for (const int dim : {2, 3}) {
    for (const PointGenerator& kind : point_generators()) {
      const std::size_t n = dim == 2 ? 1500 : 400;
      const auto positions = kind.generate(n, dim, 3).positions;
      for (const int tiles : {1, 2, 7, 16}) {
        SCOPED_TRACE(std::string(kind.name) + ", " + std::to_string(dim) + "D, " +
                     std::to_string(tiles) + " tiles");
        expect_whole(positions, dim, tiles % 4 + 1, {tiles}, tiles % 2 == 0);
      }
    }
  }
}

TEST(Tiles, GiveTheSameForEveryNumberOfRanksAndPartition) {
  const auto positions = generate_points("cluster", 3000, 2, 5).positions;
  for (const int ranks : {1, 2, 3, 4, 8}) expect_whole(positions, 2, ranks, {0}, true);
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
    SCOPED_TRACE(partitioner.name);
    expect_whole(positions, 2, 3, {5, partitioner.name}, false);
  }
}

// Methods that have no mesh to give are matched facet by facet.
TEST(Tiles, GiveTheSameByEveryMethod) {
  for (const int dim : {2, 3}) {
    const auto positions = generate_points("gauss", dim == 2 ? 600 : 200, dim, 5).positions;
    for (const Method& method : methods()) {
      if (std::ranges::find(method.dims, dim) == method.dims.end()) continue;
      SCOPED_TRACE(method.name);
      TileOptions options{5};
      options.triangulate.method = method.name;
      expect_whole(positions, dim, 2, options, true);
    }
  }
}

TEST(Tiles, TakeFewPoints) {
  const std::vector<glm::dvec3> positions = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0}, {0, 0, 1},
                                             {1, 1, 1}, {2, 0.5, 3}, {0, 0, 0}, {-1, -2, 0.5}};
  for (const int dim : {2, 3}) {
    for (std::size_t n = 0; n <= positions.size(); ++n) {
      SCOPED_TRACE(std::to_string(n) + " points, " + std::to_string(dim) + "D");
      expect_whole({positions.begin(), positions.begin() + static_cast<std::ptrdiff_t>(n)}, dim, 3,
                   {5}, true);
    }
  }
}

// Each tile has points of one line or plane only, and knows of no other until told.
TEST(Tiles, MeetAcrossFlatOnes) {
  std::vector<glm::dvec3> positions;
  for (int i = 0; i < 40; ++i) {
    for (int row = 0; row < 4; ++row) positions.emplace_back(i, 1000 * row, (i * 7 + row) % 5);
  }
  for (const int tiles : {2, 4, 8}) {
    expect_whole(positions, 2, 2, {tiles}, true);
    expect_whole(positions, 3, 2, {tiles}, false);
  }
  for (glm::dvec3& position : positions) position.y = 5;
  expect_whole(positions, 2, 3, {4}, true);  // no simplices at all
}

TEST(Tiles, LowestRowRepresentsEqualPoints) {
  auto positions = generate_points("uniform", 500, 2, 1).positions;
  const auto copies = positions;
  positions.insert(positions.begin(), copies.rbegin(), copies.rend());
  for (const bool runs : {false, true}) expect_whole(positions, 2, 4, {6}, runs);
}

TEST(Tiles, KeepRowsBeyondThirtyTwoBits) {
  const auto positions = generate_points("uniform", 300, 2, 1).positions;
  constexpr std::uint64_t kFar = std::uint64_t{1} << 40;
  TileOptions options{4};
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    const auto points = with_rows(positions, kFar);
    const TiledTriangulation far = triangulate_tiles(communicator, points, options);
    const TiledTriangulation near =
        triangulate_tiles(communicator, with_rows(positions, 0), options);
    ASSERT_EQ(far.vertices.size(), near.vertices.size());
    for (std::size_t i = 0; i < far.vertices.size(); ++i) {
      ASSERT_EQ(far.vertices[i], near.vertices[i] + kFar);
    }
  });
}

// Halos grow with the border of a tile, not with its inside, and one exchange is enough. A square
// tile of n points has about 4 sqrt(n) along its border.
TEST(Tiles, TellFewOfUniformPoints) {
  const auto points = with_rows(generate_points("uniform", 40000, 2, 7).positions, 0);
  const Whole whole = triangulate_on(4, points, {16}, true);
  EXPECT_EQ(whole.rounds, 1);
  std::uint64_t halo = 0;
  for (const TileStatistics& tile : whole.tiles) {
    halo += tile.halo;
    EXPECT_LT(tile.halo, 600U) << "of " << tile.points;
  }
  EXPECT_LT(halo, 2U * 16U * 4U * 50U);
}

// Counted: all simplices that a rank's triangulations have, those of its halo and of what is made
// again included.
TEST(Tiles, RanksCreateAboutAsManySimplices) {
  constexpr int kRanks = 16;
  for (const char* kind : {"cluster", "uniform"}) {
    const auto points = with_rows(generate_points(kind, 100000, 2, 1).positions, 0);
    std::vector<std::uint64_t> created(kRanks);
    comm::run_threads(kRanks, 1, [&](comm::Communicator& communicator) {
      const auto rank = static_cast<std::size_t>(communicator.rank());
      std::vector<RowPoint> mine;
      for (std::size_t i = rank; i < points.size(); i += kRanks) mine.push_back(points[i]);
      const TiledTriangulation made = triangulate_tiles(communicator, mine, {});
      created[rank] = made.shared.simplices;
      for (const TileStatistics& tile : made.tiles) created[rank] += tile.simplices;
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t each : created) sum += each;
    EXPECT_GE(sum, 199000U);
    EXPECT_LE(*std::ranges::max_element(created), sum / kRanks * 5 / 4) << kind;
  }
}

TEST(Tiles, RefuseWhatCannotBe) {
  const std::vector<RowPoint> points = {{{0, 0, 0}, 7}, {{1, std::nan(""), 0}, 8}};
  comm::run_threads(2, 1, [&](comm::Communicator& communicator) {
    const auto complaint = [&](std::span<const RowPoint> given, const TileOptions& options) {
      try {
        triangulate_tiles(communicator, given, options);
      } catch (const std::invalid_argument& error) {
        return std::string(error.what());
      }
      return std::string();
    };
    const std::span<const RowPoint> given = points;
    // Only one of the ranks has it; both say so.
    EXPECT_NE(complaint(communicator.rank() == 0 ? given : given.first(0), {}).find("row 8"),
              std::string::npos);
    EXPECT_NE(complaint(given.first(1), {-1}).find("-1 tiles"), std::string::npos);
    EXPECT_NE(complaint(given.first(1), {1, "no"}).find("'no' is no partition"), std::string::npos);
    TileOptions flat;
    flat.triangulate.dim = 4;
    EXPECT_NE(complaint(given.first(1), flat), "");
  });
}

}  // namespace
}  // namespace delray::delaunay
