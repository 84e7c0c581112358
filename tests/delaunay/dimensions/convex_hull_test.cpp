// Hulls are what Delaunay triangulations end at.
#include "delaunay/dimensions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "delaunay/dimensions/determinants.h"
#include "delaunay/write_mesh.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

// Sorted facets, each with its lowest vertex first and its orientation kept.
template <std::size_t D>
std::set<std::array<std::uint32_t, D>> facets_of(const std::vector<std::uint32_t>& vertices) {
  std::set<std::array<std::uint32_t, D>> result;
  for (std::size_t i = 0; i < vertices.size(); i += D) {
    std::array<std::uint32_t, D> facet;
    std::copy_n(vertices.begin() + static_cast<std::ptrdiff_t>(i), D, facet.begin());
    bool is_even = true;
    for (std::size_t a = 0; a < D; ++a) {
      for (std::size_t b = a + 1; b < D; ++b) is_even = is_even == (facet[a] < facet[b]);
    }
    std::ranges::sort(facet);
    if (!is_even) std::swap(facet[D - 2], facet[D - 1]);
    result.insert(facet);
  }
  EXPECT_EQ(result.size() * D, vertices.size()) << "a facet is there twice";
  return result;
}

template <int D>
void expect_hulls() {
  std::uint64_t seed = 0;
  for (const auto& kind : hard_points_of<D>()) {
    for (const std::size_t n : {5, 60}) {
      const auto points = kind.make(n, ++seed);
      const Triangulation expected = expected_of(points, D);
      const ConvexHull hull = convex_hull(view(points), D);
      EXPECT_EQ(facets_of<D>(hull.facets), facets_of<D>(hull_facets(expected)))
          << D << "D " << kind.name << ", n " << n << ", seed " << seed;
      EXPECT_EQ(hull.size(), expected.hull_facets) << kind.name;
      EXPECT_EQ(hull.distinct, expected.distinct) << kind.name;
      EXPECT_EQ(hull.dim, D);
    }
  }
}

TEST(ConvexHull, IsTheDelaunayTriangulationsInThePlane) { expect_hulls<2>(); }
TEST(ConvexHull, IsTheDelaunayTriangulationsInSpace) { expect_hulls<3>(); }

using internal::PlaceNd;
using Places = std::vector<PlaceNd<4>>;

PointView<double> view_of_four(const Places& points) {
  return {reinterpret_cast<const std::byte*>(points.data()), points.size(), sizeof(PlaceNd<4>)};
}

// The facets of one simplex only, and det(t1 - t0, ..., q - t0) < 0 for the corner q across.
std::vector<std::uint32_t> ends_of(const Triangulation& mesh, const Places& points) {
  std::map<std::array<std::uint32_t, 4>, std::pair<int, std::array<std::uint32_t, 4>>> facets;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    for (std::size_t k = 0; k < 5; ++k) {
      std::array<std::uint32_t, 4> facet;
      for (std::size_t j = 0, i = 0; j < 5; ++j) {
        if (j != k) facet[i++] = mesh.vertices[5 * t + j];
      }
      std::array<const PlaceNd<4>*, 5> at;
      for (std::size_t i = 0; i < 4; ++i) at[i] = &points[facet[i]];
      at[4] = &points[mesh.vertices[5 * t + k]];
      auto key = facet;
      std::ranges::sort(key);
      if (internal::orientation_nd<4>(at) > 0) std::swap(facet[0], facet[1]);
      auto& known = facets[key];
      ++known.first;
      known.second = facet;
    }
  }
  std::vector<std::uint32_t> result;
  for (const auto& [key, known] : facets) {
    if (known.first == 1) result.insert(result.end(), known.second.begin(), known.second.end());
  }
  return result;
}

TEST(ConvexHull, IsTheDelaunayTriangulationsInFour) {
  std::mt19937_64 random(4);
  int flat = 0;
  for (int i = 0; i < 120; ++i) {
    Places points(i % 2 == 0 ? 12 : 40);
    for (auto& p : points) {
      for (double& x : p) {
        x = i % 4 == 3 ? std::uniform_real_distribution<>(-1, 1)(random)
                       : static_cast<double>(random() % (2 + static_cast<unsigned>(i) % 3));
      }
      if (i % 6 == 0) p[3] = p[0];
    }
    const Triangulation mesh = triangulate_dimensions(view_of_four(points), 4);
    const ConvexHull hull = convex_hull(view_of_four(points), 4);
    EXPECT_EQ(facets_of<4>(hull.facets), facets_of<4>(ends_of(mesh, points))) << "set " << i;
    EXPECT_EQ(hull.distinct, mesh.distinct);
    flat += hull.size() == 0 ? 1 : 0;
  }
  EXPECT_GE(flat, 10);
  EXPECT_LT(flat, 40);
}

TEST(ConvexHull, RefusesWhatCannotBe) {
  Places points(3);
  EXPECT_THROW(convex_hull(view_of_four(points), 5), std::invalid_argument);
  EXPECT_THROW(convex_hull(view_of_four(points), 1), std::invalid_argument);
  points[1][2] = NAN;
  EXPECT_THROW(convex_hull(view_of_four(points), 4), std::invalid_argument);
  const std::vector<glm::dvec2> flat(3);
  EXPECT_THROW(convex_hull(view(flat), 3), std::invalid_argument);
  EXPECT_EQ(convex_hull({nullptr, 0, 32}, 4).size(), 0U);
}

}  // namespace
}  // namespace delray::delaunay
