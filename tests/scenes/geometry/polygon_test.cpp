#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "scenes/geometry/orientation.h"
#include "scenes/geometry/polygon.h"

namespace delray::scenes::internal {
namespace {

std::vector<glm::uvec3> triangulate(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < positions.size(); ++i) corners.push_back(i);
  std::vector<glm::uvec3> triangles;
  triangulate_polygon(corners, positions, triangles);
  return triangles;
}

TEST(Polygon, AConvexOneBecomesAFan) {
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(triangulate({{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}),
            (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, ADartIsCutAtItsNotch) {
  const auto triangles = triangulate({{0, 0, 0}, {2, 0, 0}, {0.4F, 0.4F, 0}, {0, 2, 0}});
  ASSERT_EQ(triangles.size(), 2U);
  for (const glm::uvec3& t : triangles) {
    EXPECT_TRUE(t.x == 0 || t.y == 0 || t.z == 0);
    EXPECT_TRUE(t.x == 2 || t.y == 2 || t.z == 2);
  }
}

// Stars around a centre are simple; triangles that keep the polygon's sense and add up to its area
// cover it.
TEST(Polygon, RandomStarsAreCoveredInAnyPlane) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 40;
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)) - 0.5);
    const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0.3, -0.8, 0.52)));
    const glm::dvec3 v = glm::cross(normal, u);
    std::vector<glm::vec3> positions;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n, radius = 0.2 + unit(random);
      positions.emplace_back(u * (radius * std::cos(angle)) + v * (radius * std::sin(angle)));
    }
    const auto area = [&](std::size_t a, std::size_t b, std::size_t c) {
      return 0.5 * glm::dot(normal, glm::cross(glm::dvec3(positions[b] - positions[a]),
                                               glm::dvec3(positions[c] - positions[a])));
    };
    double whole = 0, covered = 0;
    for (std::size_t i = 1; i + 1 < positions.size(); ++i) whole += area(0, i, i + 1);
    const auto triangles = triangulate(positions);
    ASSERT_EQ(triangles.size(), positions.size() - 2);
    for (const glm::uvec3& t : triangles) {
      ASSERT_GT(area(t.x, t.y, t.z), -1e-6) << "trial " << trial;
      covered += area(t.x, t.y, t.z);
    }
    ASSERT_NEAR(covered, whole, 1e-5) << "trial " << trial;
  }
}

// Twice the area of triangles in the plane z = 0; all of them must keep the polygon's sense.
double area_of(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions) {
  double sum = 0;
  for (const glm::uvec3& t : triangles) {
    const glm::dvec2 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_GE(area, 0);
    sum += area;
  }
  return sum;
}

double area_within(const std::vector<glm::vec3>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 a(outline[i]), b(outline[(i + 1) % outline.size()]);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

void expect_covered(const std::vector<glm::vec3>& outline) {
  const auto triangles = triangulate(outline);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  const double area = area_within(outline);
  EXPECT_NEAR(area_of(triangles, outline), area, 1e-9 * std::abs(area));
}

TEST(Polygon, OneWithAHoleThatAnEdgeJoinsToTheOutline) {
  expect_covered({{0, 0, 0},
                  {4, 0, 0},
                  {4, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},  // outline, and the bridge
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0}});
  // Two holes on a bridge of several edges, whose inner corners are left out.
  const std::vector<glm::vec3> outline = {{0, 0, 0}, {9, 0, 0}, {9, 4, 0}, {0, 4, 0}, {0, 2, 0},
                                          {1, 2, 0}, {2, 2, 0}, {3, 3, 0}, {4, 2, 0}, {5, 2, 0},
                                          {6, 3, 0}, {7, 2, 0}, {6, 1, 0}, {5, 2, 0}, {4, 2, 0},
                                          {3, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}};
  EXPECT_EQ(triangulate(outline).size(), outline.size() - 4);
  EXPECT_EQ(area_of(triangulate(outline), outline), area_within(outline));
}

TEST(Polygon, OneThatTouchesItself) {
  // The tip at (2, 1) stands on the middle of the lower side, which has a corner there.
  expect_covered({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}});
  expect_covered(
      {{0, 4, 0}, {2, 4, 0}, {0, 0, 0}, {4, 0, 0}, {2, 4, 0}, {4, 4, 0}, {4, 6, 0}, {0, 6, 0}});
}

TEST(Polygon, ASpikeIsLeftOut) {
  const std::vector<glm::vec3> outline = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 2, 0},
                                          {1, 1, 0}, {2, 2, 0}, {0, 4, 0}};
  EXPECT_EQ(area_of(triangulate(outline), outline), area_within(outline));
}

// Outlines of sets of cells of a grid: most corners lie on lines with others.
TEST(Polygon, StaircasesOfManyCornersOnALine) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 400; ++trial) {
    // Two walks to the right that do not meet, every step of them a corner.
    const int columns = 2 + trial % 30;
    std::vector<glm::vec3> lower, upper;
    for (int i = 0; i < columns; ++i) {
      const int low = static_cast<int>(random() % 4), high = 4 + static_cast<int>(random() % 4);
      for (const int x : {i, i + 1}) {
        if (lower.empty() || lower.back() != glm::vec3(x, low, 0)) lower.emplace_back(x, low, 0);
        if (upper.empty() || upper.back() != glm::vec3(x, high, 0)) upper.emplace_back(x, high, 0);
      }
    }
    lower.insert(lower.end(), upper.rbegin(), upper.rend());
    if (trial % 3 == 1) {  // turned by a right angle
      for (glm::vec3& p : lower) p = {-p.y, p.x, 0};
    }
    if (trial % 3 == 2) {  // sheared
      for (glm::vec3& p : lower) p = {p.x + 3 * p.y, p.y - p.x, 0};
    }
    std::rotate(lower.begin(), lower.begin() + trial % static_cast<int>(lower.size()), lower.end());
    SCOPED_TRACE(trial);
    expect_covered(lower);
    if (HasFailure()) return;
  }
}

// A polygon that a random tree in a grid outlines: narrow, winding and full of splits and merges.
TEST(Polygon, OutlinesOfRandomTrees) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    const int side = 3 + trial % 20;
    // The depth-first walk round the tree with its right hand on it.
    std::vector<std::vector<int>> children(static_cast<std::size_t>(side * side));
    std::vector<int> stack = {0};
    std::vector<bool> seen(children.size(), false);
    seen[0] = true;
    const std::array<int, 4> dx = {1, 0, -1, 0}, dy = {0, 1, 0, -1};
    while (!stack.empty()) {
      const std::size_t at = random() % 3 == 0 ? random() % stack.size() : stack.size() - 1;
      const int cell = stack[at];
      std::vector<int> free;
      for (std::size_t k = 0; k < 4; ++k) {
        const int x = cell % side + dx[k], y = cell / side + dy[k];
        if (x >= 0 && y >= 0 && x < side && y < side &&
            !seen[static_cast<std::size_t>(y * side + x)])
          free.push_back(y * side + x);
      }
      if (free.empty()) {
        stack.erase(stack.begin() + static_cast<std::ptrdiff_t>(at));
        continue;
      }
      const int next = free[random() % free.size()];
      seen[static_cast<std::size_t>(next)] = true;
      children[static_cast<std::size_t>(cell)].push_back(next);
      stack.push_back(next);
    }
    // Cells are squares of side 2 in a grid of 4, joined by strips of width 2 over the gaps: the
    // outline goes over the four corners of each cell, and where a neighbour is joined, out to it.
    std::vector<glm::vec3> outline;
    const auto walk = [&](const auto& self, int cell, int came_from) -> void {
      const float x = static_cast<float>(cell % side * 4), y = static_cast<float>(cell / side * 4);
      const std::array<glm::vec3, 4> corner = {glm::vec3(x + 2, y, 0), glm::vec3(x + 2, y + 2, 0),
                                               glm::vec3(x, y + 2, 0), glm::vec3(x, y, 0)};
      // Side k, to the right, top, left and bottom, goes from corner[k] to corner[(k + 1) % 4].
      int first = 0;
      for (int k = 0; k < 4; ++k) {
        const auto d = static_cast<std::size_t>(k);
        if (came_from >= 0 && came_from == cell + dx[d] + dy[d] * side) first = k + 1;
      }
      const int sides = came_from >= 0 ? 3 : 4;
      outline.push_back(corner[static_cast<std::size_t>(first % 4)]);
      for (int s = 0; s < sides; ++s) {
        const auto d = static_cast<std::size_t>((first + s) % 4);
        const int neighbour = cell + dx[d] + dy[d] * side;
        const auto& joined = children[static_cast<std::size_t>(cell)];
        const bool is_child = std::find(joined.begin(), joined.end(), neighbour) != joined.end() &&
                              (dx[d] == 0 || neighbour / side == cell / side);
        if (is_child) self(self, neighbour, cell);
        if (s + 1 < sides || came_from >= 0) outline.push_back(corner[(d + 1) % 4]);
      }
    };
    walk(walk, 0, -1);
    SCOPED_TRACE(trial);
    expect_covered(outline);
    for (glm::vec3& p : outline) p = {p.x * 0.37F + p.y * 0.11F, p.y * 0.71F - p.x * 0.23F, 0};
    const auto triangles = triangulate(outline);
    EXPECT_EQ(triangles.size(), outline.size() - 2);
    EXPECT_NEAR(area_of(triangles, outline), area_within(outline), 1e-4);
    if (HasFailure()) return;
  }
}

// Each of these would take hours if every corner were compared with every other.
TEST(Polygon, AMillionCorners) {
  constexpr int kHalf = 500'000;
  std::vector<glm::vec3> comb, spiral, star;
  for (int i = 0; i < kHalf; ++i) comb.emplace_back(2 * i, i % 2 == 0 ? 0 : 1000, 0);
  for (int i = kHalf; i-- > 0;) comb.emplace_back(2 * i, i % 2 == 0 ? 10 : 1010, 0);
  expect_covered(comb);
  for (int i = 0; i < kHalf; ++i) {
    const double angle = i * 0.01, radius = 1000 + i;
    spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  for (int i = kHalf; i-- > 0;) {
    const double angle = i * 0.01, radius = 900 + i;
    spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  std::reverse(spiral.begin(), spiral.end());
  if (area_within(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  expect_covered(spiral);
  std::mt19937 random(5);
  for (int i = 0; i < kHalf; ++i) {
    const double angle = 2 * std::numbers::pi * i / kHalf, radius = 1000.0 + random() % 1000;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  // The longest rays are thinner than single precision can tell: the sense is checked elsewhere.
  EXPECT_EQ(triangulate(star).size(), star.size() - 2);
}

TEST(Polygon, OnesThatCrossThemselvesEverywhereTakeNoLonger) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const int corners : {4'000, 200'000}) {
    std::vector<glm::vec3> tangle;
    for (int i = 0; i < corners; ++i) tangle.emplace_back(unit(random), unit(random), 0);
    const auto triangles = triangulate(tangle);
    EXPECT_EQ(triangles.size(), tangle.size() - 2);
  }
}

TEST(Polygon, DegenerateOnesGiveTrianglesOfTheirCorners) {
  const std::vector<std::vector<glm::vec3>> outlines = {
      std::vector<glm::vec3>(7, glm::vec3(1, 2, 3)),
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}},
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}}};
  for (const auto& outline : outlines) {
    const auto triangles = triangulate(outline);
    EXPECT_LE(triangles.size(), outline.size() - 2);
    for (const glm::uvec3& t : triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), outline.size());
  }
  std::mt19937 random(9);
  for (int trial = 0; trial < 20000; ++trial) {  // any polygons at all on few places
    std::vector<glm::vec3> outline;
    for (int i = 0; i < 4 + trial % 12; ++i)
      outline.emplace_back(random() % 4, random() % 4, random() % 2);
    for (const glm::uvec3& t : triangulate(outline))
      ASSERT_LT(std::max({t.x, t.y, t.z}), outline.size());
  }
}

TEST(Orientation, IsExactWhereDoublesAreNot) {
  const float one = 1.0F, bit = 0x1p-23F;
  EXPECT_EQ(orientation({0, 0}, {1e18F, 1e18F}, {1 + bit, one}), -1);
  EXPECT_EQ(orientation({0, 0}, {1e18F, 1e18F}, {one, 1 + bit}), 1);
  EXPECT_EQ(orientation({-1e18F, -1e18F}, {1e18F, 1e18F}, {3e-18F, 3e-18F}), 0);
  EXPECT_EQ(orientation({-1e18F, -1e18F}, {1e18F, 1e18F}, {0, 0x1p-149F}), 1);
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {0.5F, -0x1p-149F}), -1);
}

}  // namespace
}  // namespace delray::scenes::internal
