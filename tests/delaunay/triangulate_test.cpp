// 2D triangulations against brute force, and their invariances.
#include "delaunay/triangulate.h"
#include "delaunay/combinations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "delaunay/verify.h"
#include "tests/delaunay/brute_force.h"
#include "tests/delaunay/hard_points.h"
#include "tests/delaunay/takes_long.h"

namespace delray::delaunay {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles sorted(const Triangulation& triangulation) {
  Triangles result(triangulation.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::copy_n(&triangulation.vertices[3 * i], 3, result[i].begin());
    std::sort(result[i].begin(), result[i].end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::size_t count_distinct(const Points& points) {
  std::set<std::pair<double, double>> distinct;
  for (const auto& p : points) distinct.insert({p.x, p.y});  // -0 and 0 are equivalent
  return distinct.size();
}

TEST(Triangulate, IsTheBruteForceTriangulationOfHardPoints) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 2, 3, 4, 5, 6, 7, 9, 14, 26};
  for (const HardPoints& kind : hard_points()) {
    for (const std::size_t n : kSizes) {
      for (std::uint64_t seed = 0; seed < (n < 9 ? 25U : 4U); ++seed) {
        const Points points = kind.make(n, seed);
        const Triangles expected = brute_force<2>(points);
        for (const Options& options : locations_and_orders(2)) {
          const Triangulation actual = triangulate(view(points), options).triangulation;
          ASSERT_EQ(sorted(actual), expected)
              << name_of(options) << ", " << kind.name << ", n " << n << ", seed " << seed;
          ASSERT_EQ(actual.distinct, count_distinct(points)) << name_of(options) << kind.name;
        }
      }
    }
  }
}

TEST(Triangulate, TrianglesTurnLeftAndTheHullHasTheEdgesOfEulersFormula) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(200, 7);
    for (const Options& options : locations_and_orders(2)) {
      const Triangulation result = triangulate(view(points), options).triangulation;
      for (std::size_t i = 0; i < result.size(); ++i) {
        const std::uint32_t* v = &result.vertices[3 * i];
        EXPECT_EQ(orient2d(points[v[0]], points[v[1]], points[v[2]]), 1) << kind.name;
      }
      if (result.size() > 0) {
        EXPECT_EQ(result.size() + result.hull_facets + 2, 2 * result.distinct) << kind.name;
      } else {
        EXPECT_EQ(result.hull_facets, 0U);
      }
    }
  }
}

TEST(Triangulate, TheVerifierFindsLargerSetsCanonical) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(size_for(kind.name, 1000), 11);
    const Triangulation expected = triangulate(view(points)).triangulation;
    const Verdict verdict = verify_triangles(view(points), expected.vertices);
    EXPECT_TRUE(verdict.canonical) << kind.name << ": " << verdict.reason;
    for (const Options& options : locations_and_orders(2)) {
      if (takes_long(method_of(options), points.size(), kind.name)) continue;
      EXPECT_EQ(hash(triangulate(view(points), options).triangulation), hash(expected))
          << name_of(options) << ", " << kind.name;
    }
  }
}

TEST(Triangulate, DoesNotDependOnTheOrderOfRows) {
  for (const HardPoints& kind : hard_points()) {
    const Points points = kind.make(100, 3);
    Points reversed = points;
    std::reverse(reversed.begin(), reversed.end());
    // Rows mean other points now, so compare coordinates; of equal points any row will do.
    const auto coordinates = [](const Points& rows, const Triangulation& triangulation) {
      std::multiset<std::multiset<std::pair<double, double>>> result;
      for (std::size_t i = 0; i < triangulation.size(); ++i) {
        std::multiset<std::pair<double, double>> triangle;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto& p = rows[triangulation.vertices[3 * i + k]];
          triangle.insert({p.x, p.y});
        }
        result.insert(triangle);
      }
      return result;
    };
    EXPECT_EQ(coordinates(points, triangulate(view(points)).triangulation),
              coordinates(reversed, triangulate(view(reversed)).triangulation))
        << kind.name;
  }
}

TEST(Triangulate, ManyPointsInOneCellOfTheGrid) {
  // An outlier squeezes the others into one cell, whose grid has one more of its own.
  Points points = hard_points().front().make(2000, 5);
  points.push_back({1e12, 1e12});
  for (int i = 0; i < 1000; ++i) points.push_back(points[static_cast<std::size_t>(i)] * 1e-12);
  const Triangulation result = triangulate(view(points)).triangulation;
  EXPECT_EQ(result.distinct, 3001U);
  EXPECT_TRUE(verify_triangles(view(points), result.vertices).canonical);
}

TEST(Triangulate, DoesNotDependOnTheNumberOfThreads) {
  for (const HardPoints& kind : {hard_points().front(), hard_points().back()}) {
    const Points points = kind.make(4000, 6);
    const Hash128 expected = hash(triangulate(view(points)).triangulation);
    for (Options options : locations_and_orders(2)) {
      for (const int threads : {2, 3, 8}) {
        options.threads = threads;
        EXPECT_EQ(hash(triangulate(view(points), options).triangulation), expected)
            << name_of(options);
      }
    }
  }
}

TEST(Triangulate, NothingGivesNothing) {
  const Points none;
  for (const Options& options : locations_and_orders(2)) {
    const Triangulation result = triangulate(view(none), options).triangulation;
    EXPECT_EQ(result.size(), 0U);
    EXPECT_EQ(result.distinct, 0U);
  }
}

TEST(Triangulate, NamesTheRowThatIsNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    Points points = hard_points().front().make(50, 1);
    points[17].y = bad;
    points[31].x = bad;
    for (const Options& options : locations_and_orders(2)) {
      try {
        triangulate(view(points), options);
        ADD_FAILURE() << name_of(options);
      } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("row 17 "), std::string::npos) << error.what();
      }
    }
  }
}

TEST(Triangulate, ReadsTheFirstTwoCoordinatesOfStridedPoints) {
  const Points points = hard_points().front().make(100, 9);
  std::vector<glm::dvec3> with_heights;
  for (const auto& p : points) with_heights.emplace_back(p.x, p.y, -p.x);
  EXPECT_EQ(hash(triangulate(view(with_heights)).triangulation),
            hash(triangulate(view(points)).triangulation));
}

TEST(Triangulate, CountsPhasesOnlyWhenAsked) {
  const Points points = hard_points().front().make(2000, 2);
  for (Options options : locations_and_orders(2)) {
    EXPECT_EQ(triangulate(view(points), options).statistics.order, 0) << name_of(options);
    options.statistics = true;
    const Statistics statistics = triangulate(view(points), options).statistics;
    EXPECT_GT(statistics.order, 0) << name_of(options);
    EXPECT_GT(statistics.subdivide, 0) << name_of(options);
    EXPECT_GT(statistics.extract, 0) << name_of(options);
    EXPECT_GE(statistics.locate, 0) << name_of(options);
  }
}

TEST(BruteForce, SimplicesIn3DTileTheHull) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 20; ++round) {
    std::vector<glm::dvec3> points(11);
    for (auto& p : points) p = {random() % 3, random() % 3, random() % 3};
    std::map<std::array<std::uint32_t, 3>, int> facets;
    for (const auto& simplex : brute_force<3>(points)) {
      for (std::size_t skipped = 0; skipped < 4; ++skipped) {
        std::array<std::uint32_t, 3> facet;
        for (std::size_t k = 0, next = 0; k < 4; ++k) {
          if (k != skipped) facet[next++] = simplex[k];
        }
        ++facets[facet];
      }
    }
    for (const auto& [facet, uses] : facets) {
      EXPECT_LE(uses, 2);
      if (uses == 2) continue;
      std::set<int> sides;
      for (const auto& p : points) {
        sides.insert(orient3d(points[facet[0]], points[facet[1]], points[facet[2]], p));
      }
      EXPECT_FALSE(sides.contains(1) && sides.contains(-1)) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
