// The search of incremental construction beside one over all points.
#include "delaunay/construction/apex_search.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "delaunay/construction/first_delaunay.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

template <int D>
void expect_apex_is_best() {
  std::uint64_t seed = 0;
  for (const auto& kind : hard_points_of<D>()) {
    std::mt19937_64 random(++seed);
    auto points = kind.make(60, seed);
    std::set<std::array<double, 3>> seen;
    std::erase_if(points, [&](const auto& p) {
      return !seen.insert({p[0] + 0.0, p[1] + 0.0, D == 3 ? p[D - 1] + 0.0 : 0}).second;
    });
    const ApexSearch<D> search(points);
    for (int i = 0; i < 30 && points.size() > D; ++i) {
      typename ApexSearch<D>::Facet facet;
      for (auto& corner : facet) corner = points[random() % points.size()];
      const auto apex = search.find(facet);
      std::array<typename ApexSearch<D>::Point, D + 1> simplex;
      std::copy(facet.begin(), facet.end(), simplex.begin());
      if (apex) simplex[D] = points[*apex];
      EXPECT_TRUE(!apex || orientation_of(simplex) > 0) << kind.name << ", seed " << seed;
      for (const auto& q : points) {
        auto other = simplex;
        other[D] = q;
        const bool is_outside = orientation_of(other) > 0;
        const bool is_better = is_outside && (!apex || (q != simplex[D] && is_in_ball(simplex, q)));
        EXPECT_FALSE(is_better) << kind.name << ", seed " << seed;
      }
      if (apex) {
        EXPECT_EQ(search.find(facet, points[*apex]), std::nullopt);
      }
    }
  }
}

TEST(ApexSearch, FindsTheBestInThePlane) { expect_apex_is_best<2>(); }
TEST(ApexSearch, FindsTheBestInSpace) { expect_apex_is_best<3>(); }

template <int D>
void expect_first_is_delaunay() {
  std::uint64_t seed = 100;
  for (const auto& kind : hard_points_of<D>()) {
    for (int turn = 0; turn < 5; ++turn) {
      auto points = kind.make(40, ++seed);
      std::set<std::array<double, 3>> seen;
      std::erase_if(points, [&](const auto& p) {
        return !seen.insert({p[0] + 0.0, p[1] + 0.0, D == 3 ? p[D - 1] + 0.0 : 0}).second;
      });
      const Triangulation all = expected_of(points, D);
      const auto first = internal::first_delaunay_simplex<D>(ApexSearch<D>(points));
      ASSERT_EQ(first.has_value(), all.size() > 0) << kind.name << ", seed " << seed;
      if (!first) continue;
      const std::set<std::uint32_t> wanted(first->begin(), first->end());
      bool is_there = false;
      for (std::size_t i = 0; i < all.vertices.size(); i += D + 1) {
        const auto simplex = all.vertices.begin() + static_cast<std::ptrdiff_t>(i);
        is_there = is_there || wanted == std::set<std::uint32_t>(simplex, simplex + D + 1);
      }
      EXPECT_TRUE(is_there) << kind.name << ", seed " << seed;
    }
  }
}

TEST(FirstDelaunay, IsOneOfTheTriangles) { expect_first_is_delaunay<2>(); }
TEST(FirstDelaunay, IsOneOfTheTetrahedra) { expect_first_is_delaunay<3>(); }

}  // namespace
}  // namespace delray::delaunay
