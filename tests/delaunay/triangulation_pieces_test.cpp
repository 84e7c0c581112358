#include "delaunay/triangulation_pieces.h"

#include <gtest/gtest.h>

#include <set>

#include "delaunay/generate.h"
#include "parallel/arena.h"
#include "tests/delaunay/pieces_in_memory.h"

namespace delray::delaunay {
namespace {

Hash128 hash_of(int dim, const std::vector<PieceMesh>& pieces) {
  Hash128 sum;
  for (const PieceMesh& piece : pieces) {
    std::vector<std::uint64_t> rows;
    for (const std::uint32_t corner : piece.simplices) rows.push_back(piece.points[corner].row);
    sum = sum + hash(dim, rows);
  }
  return sum;
}

TEST(TriangulationPieces, HaveEverySimplexOnce) {
  for (const int dim : {2, 3}) {
    for (const PointGenerator& kind : point_generators()) {
      SCOPED_TRACE(std::string(kind.name) + " in " + std::to_string(dim) + "D");
      const PointCloud cloud = kind.generate(120, dim, 5);
      Options options;
      options.dim = dim;
      const Triangulation whole = triangulate(view(cloud.positions), options).triangulation;
      for (const std::uint64_t most : {1U, 7U, 100U, 1000000U}) {
        for (const bool runs : {false, true}) {
          tests::PiecesInMemory sink;
          parallel::Arena(3).execute(
              [&] { (runs ? give_runs : give_pieces)(view(cloud.positions), whole, most, sink); });
          const std::vector<PieceMesh> pieces = sink.all();
          EXPECT_EQ(pieces.size(), (whole.size() + most - 1) / most);
          EXPECT_EQ(hash_of(dim, pieces), hash(whole));
          for (const PieceMesh& piece : pieces) {
            EXPECT_LE(piece.simplices.size(), most * (static_cast<std::size_t>(dim) + 1));
            std::set<std::uint64_t> rows;
            for (const RowPoint& point : piece.points) {
              EXPECT_EQ(point.position, cloud.positions[point.row]);
              EXPECT_TRUE(rows.insert(point.row).second);
            }
          }
        }
      }
    }
  }
}

TEST(TriangulationPieces, OfNothingAreNone) {
  const PointCloud cloud = generate_points("uniform", 2, 2, 1);
  tests::PiecesInMemory sink;
  give_pieces(view(cloud.positions), {}, 10, sink);
  give_runs(view(cloud.positions), {}, 10, sink);
  EXPECT_TRUE(sink.all().empty());
}

}  // namespace
}  // namespace delray::delaunay
