// Delaunay triangulations in any dimension: beside the definition, and beside those of 2D and 3D.
#include "delaunay/dimensions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "delaunay/dimensions/determinants.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

using internal::PlaceNd;

template <int D>
PointView<double> view_of(const std::vector<PlaceNd<D>>& points) {
  return {reinterpret_cast<const std::byte*>(points.data()), points.size(), sizeof(PlaceNd<D>)};
}

// All simplices in whose ball no point lies, of distinct points.
template <int D>
Triangulation by_definition(const std::vector<PlaceNd<D>>& points) {
  Triangulation result;
  result.dim = D;
  std::vector<std::uint32_t> rows(points.size());
  for (std::uint32_t row = 0; row < rows.size(); ++row) {
    rows[row] = static_cast<std::uint32_t>(std::ranges::find(points, points[row]) - points.begin());
  }
  std::vector<bool> chosen(points.size());
  std::fill_n(chosen.begin(), D + 1, true);
  do {
    std::array<std::uint32_t, D + 1> simplex;
    std::array<const PlaceNd<D>*, D + 1> at;
    for (std::uint32_t row = 0, k = 0; row < rows.size(); ++row) {
      if (chosen[row]) simplex[k++] = row;
    }
    bool is_delaunay = true;
    for (std::size_t k = 0; k <= D; ++k) {
      is_delaunay = is_delaunay && rows[simplex[k]] == simplex[k];
      at[k] = &points[simplex[k]];
    }
    const int sign = is_delaunay ? internal::orientation_nd<D>(at) : 0;
    if (sign == 0) continue;
    if (sign < 0) std::swap(at[0], at[1]);
    for (std::uint32_t row = 0; row < rows.size() && is_delaunay; ++row) {
      if (rows[row] != row || std::ranges::find(simplex, row) != simplex.end()) continue;
      is_delaunay = !internal::conflict_nd<D>(at, points[row]);
    }
    if (is_delaunay) result.vertices.insert(result.vertices.end(), simplex.begin(), simplex.end());
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  result.distinct = std::set<std::uint32_t>(rows.begin(), rows.end()).size();
  return result;
}

// Coordinates among `values` integers: many of them on common spheres and hyperplanes. A random
// unit of 0 stands for points anywhere.
template <int D>
std::vector<PlaceNd<D>> random_points(std::size_t n, unsigned values, std::mt19937_64& random) {
  std::vector<PlaceNd<D>> points(n);
  for (auto& p : points) {
    for (double& x : p) {
      x = values == 0 ? std::uniform_real_distribution<>(-1, 1)(random)
                      : static_cast<double>(random() % values) - 1;
    }
  }
  return points;
}

template <int D>
void expect_definition(std::size_t n, int sets) {
  std::mt19937_64 random(D);
  for (int i = 0; i < sets; ++i) {
    const unsigned values = static_cast<unsigned>(i % 5 == 4 ? 0 : 2 + i % 5);
    const auto points = random_points<D>(n, values, random);
    const Triangulation expected = by_definition<D>(points);
    const Triangulation actual =
        triangulate_dimensions(view_of<D>(points), D, static_cast<std::uint64_t>(i));
    ASSERT_EQ(hash(actual), hash(expected)) << D << "D, set " << i;
    ASSERT_EQ(actual.distinct, expected.distinct) << D << "D, set " << i;
    ASSERT_EQ(actual.dim, D);
  }
}

TEST(Dimensions, GiveTheDefinitionInThePlane) { expect_definition<2>(10, 100); }
TEST(Dimensions, GiveTheDefinitionInSpace) { expect_definition<3>(9, 100); }
TEST(Dimensions, GiveTheDefinitionInFour) { expect_definition<4>(10, 200); }
TEST(Dimensions, GiveTheDefinitionInFive) { expect_definition<5>(10, 60); }
TEST(Dimensions, GiveTheDefinitionInSix) { expect_definition<6>(10, 30); }

template <int D>
void expect_triangulate() {
  std::uint64_t seed = 0;
  for (const auto& kind : hard_points_of<D>()) {
    const auto points = kind.make(60, ++seed);
    const Triangulation expected = expected_of(points, D);
    const Triangulation actual = triangulate_dimensions(view(points), D, seed);
    EXPECT_EQ(hash(actual), hash(expected)) << kind.name << ", seed " << seed;
    EXPECT_EQ(actual.distinct, expected.distinct) << kind.name << ", seed " << seed;
    EXPECT_EQ(actual.hull_facets, expected.hull_facets) << kind.name << ", seed " << seed;
  }
}

TEST(Dimensions, GiveWhatTriangulateDoesInThePlane) { expect_triangulate<2>(); }
TEST(Dimensions, GiveWhatTriangulateDoesInSpace) { expect_triangulate<3>(); }

// The simplices of a triangulation of a convex body fill it: volumes add up to the hypercube's.
TEST(Dimensions, FillAHypercube) {
  std::vector<PlaceNd<4>> points;
  for (unsigned corner = 0; corner < 16; ++corner) {
    points.push_back({double(corner & 1), double(corner >> 1 & 1), double(corner >> 2 & 1),
                      double(corner >> 3 & 1)});
  }
  const Triangulation cube = triangulate_dimensions(view_of<4>(points), 4);
  double volume = 0;
  for (std::size_t i = 0; i < cube.vertices.size(); i += 5) {
    glm::dmat4 edges;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        const auto at = [&](std::size_t corner) {
          return points[cube.vertices[i + corner]][static_cast<std::size_t>(j)];
        };
        edges[k][j] = at(static_cast<std::size_t>(k) + 1) - at(0);
      }
    }
    EXPECT_GT(glm::determinant(edges), 0);
    volume += std::round(glm::determinant(edges));
  }
  EXPECT_EQ(volume, 24);  // times 4!
}

TEST(Dimensions, FlatPointsHaveNoSimplices) {
  std::mt19937_64 random(1);
  auto points = random_points<5>(40, 4, random);
  for (auto& p : points) p[3] = p[0] + p[1];
  const Triangulation flat = triangulate_dimensions(view_of<5>(points), 5);
  EXPECT_EQ(flat.size(), 0U);
  EXPECT_GT(flat.distinct, 30U);
  EXPECT_EQ(triangulate_dimensions({nullptr, 0, 40}, 5).size(), 0U);
}

TEST(Dimensions, RefuseWhatCannotBe) {
  std::vector<PlaceNd<4>> points(3);
  EXPECT_THROW(triangulate_dimensions(view_of<4>(points), 7), std::invalid_argument);
  EXPECT_THROW(triangulate_dimensions(view_of<4>(points), 1), std::invalid_argument);
  points[2][3] = INFINITY;
  EXPECT_THROW(triangulate_dimensions(view_of<4>(points), 4), std::invalid_argument);
}

}  // namespace
}  // namespace delray::delaunay
