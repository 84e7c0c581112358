// Extraction skips ghosts and dead slots and keeps the creators.
#include "delaunay/mesh/extract.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "parallel/arena.h"

namespace delray::delaunay::internal {
namespace {

using Simplex = std::vector<std::uint32_t>;

// Every fifth is a ghost, every fifth is dead. Large enough for memory that is given back by pages.
template <int D>
void expect_finite(SimplexNumber simplices, int threads) {
  Mesh<D> mesh(simplices);
  std::vector<std::uint32_t> rows((D + 1) * std::size_t{simplices});
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<std::uint32_t>(2 * i + 1);
  std::vector<Simplex> expected;
  std::vector<std::uint16_t> created_by(simplices), expected_created_by;
  for (SimplexNumber t = 0; t < simplices; ++t) {
    for (unsigned k = 0; k <= D; ++k) mesh.set_vertex(corner_of(t, k), (D + 1) * t + k);
    if (t % 5 == 1) mesh.set_vertex(corner_of(t, t % (D + 1)), kInfiniteVertex);
    if (t % 5 == 2) mesh.set_vertex(corner_of(t, 0), kDeadVertex);
    EXPECT_EQ(mesh.is_ghost(t), t % 5 == 1);
    EXPECT_EQ(mesh.is_dead(t), t % 5 == 2);
    created_by[t] = static_cast<std::uint16_t>(t % 1013);
    if (t % 5 == 1 || t % 5 == 2) continue;
    expected_created_by.push_back(created_by[t]);
    const auto first = rows.begin() + (D + 1) * std::ptrdiff_t{t};
    expected.emplace_back(first, first + D + 1);
  }
  const auto [result, statistics, creators] = parallel::Arena(threads).execute(
      [&] { return extract(std::move(mesh), rows, threads, created_by); });
  EXPECT_EQ(result.dim, D);
  EXPECT_EQ(result.distinct, rows.size());
  EXPECT_EQ(result.hull_facets, simplices / 5);
  std::vector<Simplex> actual;
  for (auto at = result.vertices.begin(); at != result.vertices.end(); at += D + 1) {
    actual.emplace_back(at, at + D + 1);
  }
  EXPECT_EQ(creators, expected_created_by);
  EXPECT_EQ(actual, expected) << D << "D, " << threads << " threads";
}

TEST(Extract, SkipsGhostsAndTheDead) {
  for (const int threads : {1, 3}) {
    for (const SimplexNumber simplices : {0U, 5U, 600000U}) {
      expect_finite<2>(simplices, threads);
      expect_finite<3>(simplices / 3, threads);
    }
  }
}

// Only ghosts are left of collinear points.
TEST(Extract, NothingIsBoundedByGhostsAlone) {
  Mesh<2> mesh(2);
  for (unsigned corner = 0; corner < 8; ++corner) {
    if (corner % 4 < 3) mesh.set_vertex(corner, corner % 4 == 2 ? kInfiniteVertex : corner % 4);
  }
  const Triangulation result =
      extract(std::move(mesh), std::vector<std::uint32_t>{0, 1}).triangulation;
  EXPECT_EQ(result.size(), 0U);
  EXPECT_EQ(result.hull_facets, 0U);
  EXPECT_EQ(result.distinct, 2U);
}

}  // namespace
}  // namespace delray::delaunay::internal
