// Simplified terrains stay within their bound, exactly.
#include "delaunay/simplify_terrain.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "delaunay/predicates.h"
#include "delaunay/triangulate.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

using Terrain = std::vector<glm::dvec3>;

Terrain lattice(int side, double (*height)(double x, double y)) {
  Terrain terrain;
  for (int i = 0; i < side * side; ++i) {
    const double x = i % side, y = i / side;
    terrain.emplace_back(x, y, height(x, y));
  }
  return terrain;
}

double hills(double x, double y) { return 5 * std::sin(0.4 * x) * std::cos(0.3 * y) + 0.1 * x; }

// |the surface below or above q - q| exactly; -1 where there is none.
mpq_class exact_error(const Terrain& terrain, const Triangulation& surface, const glm::dvec3& q) {
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const std::uint32_t* v = &surface.vertices[3 * t];
    const glm::dvec3 &a = terrain[v[0]], &b = terrain[v[1]], &c = terrain[v[2]];
    const glm::dvec2 a2(a), b2(b), c2(c), q2(q);
    if (orient2d(a2, b2, q2) < 0 || orient2d(b2, c2, q2) < 0 || orient2d(c2, a2, q2) < 0) continue;
    const auto area = [](const glm::dvec3& p, const glm::dvec3& r, const glm::dvec3& s) {
      return mpq_class((mpq_class(r.x) - p.x) * (mpq_class(s.y) - p.y) -
                       (mpq_class(r.y) - p.y) * (mpq_class(s.x) - p.x));
    };
    const mpq_class wa = area(q, b, c), wb = area(q, c, a), wc = area(q, a, b);
    return abs((wa * a.z + wb * b.z + wc * c.z) / (wa + wb + wc) - q.z);
  }
  return -1;
}

// That the result is what triangulate() makes of the points that are kept.
void expect_delaunay(const Terrain& terrain, const SimplifiedTerrain& result) {
  Terrain kept;
  for (const std::uint32_t row : result.kept) kept.push_back(terrain[row]);
  Triangulation expected = triangulate(view(kept)).triangulation;
  for (std::uint32_t& vertex : expected.vertices) vertex = result.kept[vertex];
  EXPECT_EQ(hash(result.triangulation), hash(expected));
  EXPECT_EQ(result.triangulation.hull_facets, expected.hull_facets);
  EXPECT_EQ(result.triangulation.distinct, triangulate(view(terrain)).triangulation.distinct);
  EXPECT_TRUE(std::ranges::is_sorted(result.kept));
}

void expect_within(const Terrain& terrain, double bound, int threads) {
  const SimplifiedTerrain result = simplify_terrain(view(terrain), bound, nullptr, threads);
  expect_delaunay(terrain, result);
  std::set<std::pair<double, double>> seen;
  for (const glm::dvec3& q : terrain) {
    if (!seen.insert({q.x, q.y}).second || result.triangulation.size() == 0) continue;
    const mpq_class error = exact_error(terrain, result.triangulation, q);
    ASSERT_GE(error, 0);
    ASSERT_LE(error, bound);
    EXPECT_LE(error.get_d(), result.largest_error + 1e-9 * (std::abs(q.z) + bound) + 1e-300);
  }
  EXPECT_LE(result.largest_error, bound);
}

void expect_within(const Terrain& terrain, double bound) {
  for (const int threads : {1, 2}) expect_within(terrain, bound, threads);
}

TEST(SimplifyTerrain, KeepsTheBoundOnHills) {
  const Terrain terrain = lattice(20, hills);
  std::size_t before = terrain.size() + 1;
  for (const double bound : {0.0, 0.01, 0.1, 1.0, 1000.0}) {
    SCOPED_TRACE(bound);
    expect_within(terrain, bound);
    const std::size_t kept = simplify_terrain(view(terrain), bound).kept.size();
    EXPECT_LT(kept, before);
    before = kept;
  }
  EXPECT_EQ(before, 4U);
}

TEST(SimplifyTerrain, KeepsTheBoundOnHardPoints) {
  for (const HardPoints& kind : hard_points()) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(kind.name + ", seed " + std::to_string(seed));
      std::mt19937_64 random(seed);
      Terrain terrain;
      for (const glm::dvec2& p : kind.make(70, seed)) {
        terrain.emplace_back(p, static_cast<double>(random() % 6));
      }
      for (const double bound : {0.0, 0.3, 2.0}) expect_within(terrain, bound);
    }
  }
}

TEST(SimplifyTerrain, HeightsOfAnySizeAreBoundedToo) {
  std::mt19937_64 random(3);
  for (const double size : {1e300, 1e-300, std::numeric_limits<double>::max()}) {
    SCOPED_TRACE(size);
    Terrain terrain = lattice(8, hills);
    for (glm::dvec3& p : terrain) p.z = size * (static_cast<double>(random() % 9) / 4 - 1);
    expect_within(terrain, 0);
    expect_within(terrain, 0.4 * size);
    expect_within(terrain, std::numeric_limits<double>::max());
  }
}

// Tenths are rounded: what they add up to is not.
TEST(SimplifyTerrain, BoundsAreExactWhereSumsAreRounded) {
  const Terrain terrain = lattice(12, [](double x, double y) {
    return 0.1 * static_cast<double>((static_cast<int>(x) * 7 + static_cast<int>(y) * 3) % 5);
  });
  for (const double bound : {0.1, 0.2, 0.3, 0.1 + 0.2}) expect_within(terrain, bound);
}

TEST(SimplifyTerrain, ZeroLeavesOutWhatIsOnTheSurface) {
  const auto plane = lattice(9, [](double x, double y) { return 2 * x - 3 * y + 7; });
  const SimplifiedTerrain flat = simplify_terrain(view(plane), 0);
  EXPECT_EQ(flat.kept, (std::vector<std::uint32_t>{0, 8, 72, 80}));
  EXPECT_EQ(flat.triangulation.size(), 2U);
  EXPECT_EQ(flat.largest_error, 0);
  Terrain needle = plane;
  needle[40].z += 1e-9;
  const SimplifiedTerrain bent = simplify_terrain(view(needle), 0);
  EXPECT_TRUE(std::ranges::binary_search(bent.kept, 40U));
  EXPECT_LT(bent.kept.size(), needle.size());
  std::mt19937_64 random(5);
  Terrain rough = plane;
  for (glm::dvec3& p : rough) p.z = std::uniform_real_distribution<>()(random);
  EXPECT_EQ(simplify_terrain(view(rough), 0).kept.size(), rough.size());
}

TEST(SimplifyTerrain, TheLowestRowStandsForAPlace) {
  Terrain terrain = lattice(5, [](double, double) { return 0.0; });
  terrain.emplace_back(2, 2, 50);
  terrain.emplace_back(0, -0.0, 50);
  EXPECT_EQ(simplify_terrain(view(terrain), 1).kept.size(), 4U);
  std::ranges::reverse(terrain);
  const SimplifiedTerrain high = simplify_terrain(view(terrain), 1);
  EXPECT_TRUE(std::ranges::binary_search(high.kept, 0U));  // (0, 0, 50), a corner
  EXPECT_TRUE(std::ranges::binary_search(high.kept, 1U));  // (2, 2, 50)
  EXPECT_EQ(high.triangulation.distinct, 25U);
}

TEST(SimplifyTerrain, KeepsTheSamePointsWhateverTheirRows) {
  Terrain terrain = lattice(15, hills);
  const auto kept = [&] {
    std::set<std::pair<double, double>> result;
    for (const std::uint32_t row : simplify_terrain(view(terrain), 0.5).kept) {
      result.insert({terrain[row].x, terrain[row].y});
    }
    return result;
  };
  const auto expected = kept();
  EXPECT_EQ(kept(), expected);
  std::ranges::shuffle(terrain, std::mt19937_64(2));
  EXPECT_EQ(kept(), expected);
}

// With enough candidates for many parts.
Terrain rough_terrain(std::uint64_t seed) {
  Terrain terrain = lattice(150, hills);
  std::mt19937_64 random(seed);
  for (glm::dvec3& p : terrain) p.z += std::uniform_real_distribution<>(-0.5, 0.5)(random);
  return terrain;
}

TEST(SimplifyTerrain, KeepsTheSamePointsWithAnyNumberOfThreadsAboveOne) {
  for (const Terrain& terrain : {lattice(60, hills), rough_terrain(7)}) {
    for (const double bound : {0.0, 0.02, 0.3, 0.5}) {
      SCOPED_TRACE(bound);
      const SimplifiedTerrain alone = simplify_terrain(view(terrain), bound);
      const SimplifiedTerrain two = simplify_terrain(view(terrain), bound, nullptr, 2);
      for (const int threads : {3, 8}) {
        const SimplifiedTerrain more = simplify_terrain(view(terrain), bound, nullptr, threads);
        EXPECT_EQ(more.kept, two.kept);
        EXPECT_EQ(hash(more.triangulation), hash(two.triangulation));
        EXPECT_EQ(more.largest_error, two.largest_error);
      }
      // Parts choose worse than one point after the other, but not much.
      EXPECT_LE(two.kept.size(), alone.kept.size() + alone.kept.size() / 10 + 8);
    }
  }
  EXPECT_THROW(simplify_terrain(view(rough_terrain(1)), 1, nullptr, 0), std::invalid_argument);
}

TEST(SimplifyTerrain, PartsKeepTheBoundAndTheDelaunayTriangulation) {
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    const Terrain terrain = rough_terrain(seed);
    const SimplifiedTerrain result = simplify_terrain(view(terrain), 0.4, nullptr, 3);
    expect_delaunay(terrain, result);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 60; ++i) {
      const glm::dvec3& q = terrain[random() % terrain.size()];
      const mpq_class error = exact_error(terrain, result.triangulation, q);
      ASSERT_GE(error, 0);
      ASSERT_LE(error, 0.4);
    }
  }
}

TEST(SimplifyTerrain, ALineHasNoSurface) {
  for (const std::size_t n : {0, 1, 2, 9}) {
    Terrain line;
    for (std::size_t i = 0; i < n; ++i) line.emplace_back(i, 2 * i, i % 3);
    const SimplifiedTerrain result = simplify_terrain(view(line), 0.5);
    EXPECT_TRUE(result.kept.empty());
    EXPECT_EQ(result.triangulation.size(), 0U);
    EXPECT_EQ(result.triangulation.distinct, n);
  }
}

TEST(SimplifyTerrain, RefusesWhatIsNotFiniteAndStopsWhenAsked) {
  Terrain terrain = lattice(30, hills);
  EXPECT_THROW(simplify_terrain(view(terrain), -1), std::invalid_argument);
  EXPECT_THROW(simplify_terrain(view(terrain), std::nan("")), std::invalid_argument);
  parallel::Progress progress;
  simplify_terrain(view(terrain), 0.1, &progress);
  EXPECT_EQ(progress.done(), terrain.size());
  progress.request_stop();
  EXPECT_THROW(simplify_terrain(view(terrain), 0.1, &progress), parallel::Interrupted);
  terrain[7].z = std::nan("");
  EXPECT_THROW(simplify_terrain(view(terrain), 1), std::invalid_argument);
}

TEST(SelectRows, TakesAllAttributes) {
  PointCloud cloud;
  cloud.has_z = true;
  cloud.positions = {{0, 0, 1}, {1, 0, 2}, {2, 0, 3}};
  cloud.intensity = {0.1F, 0.2F, 0.3F};
  const PointCloud selected = select_rows(cloud, {2, 0});
  EXPECT_TRUE(selected.has_z);
  EXPECT_EQ(selected.positions, (Terrain{{2, 0, 3}, {0, 0, 1}}));
  EXPECT_EQ(selected.intensity, (std::vector<float>{0.3F, 0.1F}));
  EXPECT_TRUE(selected.colours.empty());
}

}  // namespace
}  // namespace delray::delaunay
