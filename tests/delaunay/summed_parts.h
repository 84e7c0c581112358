// What ranks have made of points together, against one triangulation of all.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/tiles.h"
#include "delaunay/triangulation.h"

namespace delray::tests {

// The points that a rank begins with: a run of them, or each so-many-th one.
inline std::vector<delaunay::RowPoint> points_of_rank(std::span<const delaunay::RowPoint> points,
                                                      int rank, int ranks, bool runs) {
  const auto own = static_cast<std::size_t>(rank), all = static_cast<std::size_t>(ranks);
  std::vector<delaunay::RowPoint> mine;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((runs ? i * all / points.size() : i % all) == own) mine.push_back(points[i]);
  }
  return mine;
}

inline std::vector<delaunay::RowPoint> with_rows(std::span<const glm::dvec3> positions,
                                                 std::uint64_t first = 0) {
  std::vector<delaunay::RowPoint> points;
  for (const glm::dvec3& position : positions) points.push_back({position, first + points.size()});
  return points;
}

// Sums over ranks.
struct SummedParts {
  delaunay::Hash128 hash;
  std::uint64_t simplices = 0, distinct = 0, hull_facets = 0;

  void add(const delaunay::TiledTriangulation& part) {
    hash = hash + delaunay::hash(part.dim, part.vertices);
    simplices += part.vertices.size() / (static_cast<std::size_t>(part.dim) + 1);
    distinct += part.distinct;
    hull_facets += part.hull_facets;
  }
};

inline void expect_equal(const SummedParts& got, const delaunay::Triangulation& expected) {
  EXPECT_EQ(to_string(got.hash), to_string(delaunay::hash(expected)));
  EXPECT_EQ(got.simplices, expected.size());
  EXPECT_EQ(got.distinct, expected.distinct);
  EXPECT_EQ(got.hull_facets, expected.hull_facets);
}

}  // namespace delray::tests
