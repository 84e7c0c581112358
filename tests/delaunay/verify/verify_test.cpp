// The verifier accepts what is right and finds every mutation.
#include "delaunay/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "delaunay/generate.h"
#include "delaunay/predicates.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

using Triangles = std::vector<std::uint32_t>;

std::vector<glm::dvec3> points_of(const char* kind, std::size_t n, std::uint64_t seed) {
  return generate_points(kind, n, 2, seed).positions;
}

glm::dvec2 flat(const glm::dvec3& p) { return {p.x, p.y}; }

// An inner edge: triangle t has the edge from u to v, and w opposite; s has it reversed, with x.
struct Diamond {
  std::size_t t, s;
  std::uint32_t u, v, w, x;
};

std::vector<Diamond> diamonds(const Triangles& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  for (std::size_t e = 0; e < triangles.size(); ++e) {
    edges[{triangles[e - e % 3 + (e + 1) % 3], triangles[e - e % 3 + (e + 2) % 3]}] = e;
  }
  std::vector<Diamond> result;
  for (const auto& [edge, e] : edges) {
    const auto mate = edges.find({edge.second, edge.first});
    if (mate == edges.end() || edge.first > edge.second) continue;
    result.push_back(
        {e / 3, mate->second / 3, edge.first, edge.second, triangles[e], triangles[mate->second]});
  }
  return result;
}

void flip(Triangles& triangles, const Diamond& d) {
  std::ranges::copy(std::array{d.w, d.u, d.x}, triangles.begin() + static_cast<long>(3 * d.t));
  std::ranges::copy(std::array{d.x, d.v, d.w}, triangles.begin() + static_cast<long>(3 * d.s));
}

TEST(Verify, AcceptsEveryKindOfPoints) {
  for (const PointGenerator& generator : point_generators()) {
    for (const std::size_t n : {1, 2, 3, 4, 9, 100, 3000}) {
      const auto points = generator.generate(n, 2, n).positions;
      const Verdict verdict =
          verify_triangles(view(points), triangulate(view(points)).triangulation.vertices);
      EXPECT_TRUE(verdict.valid && verdict.delaunay && verdict.canonical)
          << generator.name << " " << n << ": " << verdict.reason;
      EXPECT_FALSE(verdict.simplex.has_value());
    }
  }
}

// Of a square's two diagonals the rule takes the one that avoids the lexicographically largest
// corner.
TEST(Verify, KnowsTheCanonicalDiagonal) {
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(verify_triangles(view(points), Triangles{0, 1, 3, 1, 2, 3}).canonical);
  const Verdict other = verify_triangles(view(points), Triangles{0, 1, 2, 0, 2, 3});
  EXPECT_TRUE(other.valid && other.delaunay);
  EXPECT_FALSE(other.canonical);
  EXPECT_EQ(other.simplex, 0U);
}

TEST(Verify, TellsCocircularFlipsFromWrongOnes) {
  const unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::size_t cocircular = 0, wrong = 0;
  for (const char* kind : {"grid", "uniform", "ulp", "cocircular", "jitter"}) {
    const auto points = points_of(kind, 400, 9);
    const Triangles good = triangulate(view(points)).triangulation.vertices;
    const auto inner = diamonds(good);
    for (int round = 0; round < 100; ++round) {
      const Diamond& d = inner[random() % inner.size()];
      const auto at = [&](std::uint32_t row) { return flat(points[row]); };
      const bool convex =
          orient2d(at(d.w), at(d.u), at(d.x)) > 0 && orient2d(at(d.x), at(d.v), at(d.w)) > 0;
      Triangles mutant = good;
      flip(mutant, d);
      const Verdict verdict = verify_triangles(view(points), mutant);
      EXPECT_FALSE(verdict.canonical);
      EXPECT_FALSE(verdict.reason.empty());
      EXPECT_EQ(verdict.valid, convex) << kind << ": " << verdict.reason;
      if (!convex) continue;
      const bool circle = incircle(at(d.u), at(d.v), at(d.w), at(d.x)) == 0;
      EXPECT_EQ(verdict.delaunay, circle) << kind << ": " << verdict.reason;
      ASSERT_TRUE(verdict.simplex.has_value());
      cocircular += circle ? 1 : 0;
      wrong += circle ? 0 : 1;
      // With one wrong edge its triangles, or their neighbours, are what is named.
      EXPECT_LE(*verdict.simplex, std::max(d.t, d.s));
    }
  }
  EXPECT_GT(cocircular, 50U);
  EXPECT_GT(wrong, 50U);
}

TEST(Verify, FindsEveryMutation) {
  const unsigned seed = 77;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const char* kind : {"uniform", "grid", "duplicates", "arc", "cluster", "two-lines"}) {
    const auto points = points_of(kind, 300, 4);
    const auto n = static_cast<std::uint32_t>(points.size());
    const Triangles good = triangulate(view(points)).triangulation.vertices;
    const auto rejected = [&](const Triangles& mutant) {
      return !verify_triangles(view(points), mutant).valid;
    };
    for (int round = 0; round < 60; ++round) {
      SCOPED_TRACE(kind);
      const std::size_t t = random() % (good.size() / 3);
      const long first = static_cast<long>(3 * t);

      Triangles mutant = good;  // turned over
      std::swap(mutant[3 * t], mutant[3 * t + 1]);
      EXPECT_TRUE(rejected(mutant));
      EXPECT_EQ(verify_triangles(view(points), mutant).simplex, t);

      mutant = good;  // missing
      mutant.erase(mutant.begin() + first, mutant.begin() + first + 3);
      EXPECT_TRUE(rejected(mutant));

      mutant = good;  // doubled, turned or not
      const std::size_t turn = random() % 3;
      for (std::size_t k = 0; k < 3; ++k) mutant.push_back(good[3 * t + (k + turn) % 3]);
      EXPECT_TRUE(rejected(mutant));

      mutant = good;  // another vertex
      const std::uint32_t other = static_cast<std::uint32_t>(random()) % n;
      const std::uint32_t old = mutant[3 * t];
      mutant[3 * t] = other;
      if (points[other] != points[old]) {
        EXPECT_TRUE(rejected(mutant));
      }

      mutant = good;  // no vertex
      mutant[3 * t + 1] = n + static_cast<std::uint32_t>(random() % 5);
      EXPECT_TRUE(rejected(mutant));
      EXPECT_EQ(verify_triangles(view(points), mutant).simplex, t);

      mutant = good;  // twice the same vertex
      mutant[3 * t + 1] = mutant[3 * t];
      EXPECT_TRUE(rejected(mutant));

      mutant = good;  // two triangles exchange a vertex
      const std::size_t s = random() % (good.size() / 3);
      std::swap(mutant[3 * t], mutant[3 * s]);
      if (points[mutant[3 * t]] != points[mutant[3 * s]]) {
        EXPECT_TRUE(rejected(mutant));
      }
    }
    EXPECT_TRUE(rejected({}));
    Triangles twice = good;
    twice.insert(twice.end(), good.begin(), good.end());
    EXPECT_TRUE(rejected(twice));
  }
}

TEST(Verify, MissesNoPoint) {
  std::vector<glm::dvec3> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_TRUE(verify_triangles(view(points), Triangles{0, 1, 2}).canonical);
  points.emplace_back(1, 1, 0);  // inside
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 1, 2}).valid);
  points.back() = {2, 0, 0};  // on the edge
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 1, 2}).valid);
  EXPECT_TRUE(verify_triangles(view(points), Triangles{0, 3, 2, 3, 1, 2}).canonical);
  points.back() = {5, 5, 0};  // outside
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 1, 2}).valid);
  points.back() = {0, -0.0, 0};  // equal to row 0
  const Verdict lowest = verify_triangles(view(points), Triangles{0, 1, 2});
  EXPECT_TRUE(lowest.canonical);
  EXPECT_EQ(lowest.distinct, 3U);
  const Verdict other = verify_triangles(view(points), Triangles{3, 1, 2});
  EXPECT_TRUE(other.valid && other.delaunay);
  EXPECT_FALSE(other.canonical);
}

TEST(Verify, RefusesWhatCoversTwice) {
  // A pentagram around its centre: every corner is convex, the centre is covered twice.
  std::vector<glm::dvec3> points = {{0, 0, 0},  {10, 0, 0},  {3, 9, 0},
                                    {-8, 6, 0}, {-8, -6, 0}, {3, -9, 0}};
  Triangles star;
  for (std::uint32_t i = 0; i < 5; ++i) {
    for (const std::uint32_t v : {0U, 1 + 2 * i % 5, 1 + (2 * i + 2) % 5}) star.push_back(v);
  }
  EXPECT_FALSE(verify_triangles(view(points), star).valid);
  Triangles once;
  for (std::uint32_t i = 0; i < 5; ++i) {
    for (const std::uint32_t v : {0U, 1 + i, 1 + (i + 1) % 5}) once.push_back(v);
  }
  EXPECT_TRUE(verify_triangles(view(points), once).valid);
  // Two separate convex pieces.
  points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}};
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 1, 2, 3, 4, 5}).valid);
  // Two that touch in a vertex.
  points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 1, 2, 0, 3, 4}).valid);
  // An edge with a vertex on it, on one side only.
  points = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}};
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 2, 3, 2, 1, 3, 0, 4, 1}).valid);
  EXPECT_TRUE(verify_triangles(view(points), Triangles{0, 2, 3, 2, 1, 3, 0, 4, 2, 2, 4, 1}).valid);
}

TEST(Verify, AcceptsNoTrianglesOnALineOnly) {
  std::vector<glm::dvec3> points;
  EXPECT_TRUE(verify_triangles(view(points), {}).canonical);
  points = {{1, 1, 0}, {1, 1, 5}, {2, 2, 0}, {3, 3, 7}};
  EXPECT_TRUE(verify_triangles(view(points), {}).canonical);
  EXPECT_FALSE(verify_triangles(view(points), Triangles{0, 2, 3}).valid);
  points.emplace_back(3, 3.0000000000000004, 0);
  EXPECT_FALSE(verify_triangles(view(points), {}).valid);
}

TEST(Verify, ComparesVerticesWithPoints) {
  const std::vector<glm::dvec3> points = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_FALSE(first_different_row(view(points), view(points), 3).has_value());
  std::vector<glm::dvec3> other = {{-0.0, 1, 2}, {3, 4, 6}};
  EXPECT_FALSE(first_different_row(view(other), view(points), 2).has_value());
  EXPECT_EQ(first_different_row(view(other), view(points), 3), 1U);
  other.pop_back();
  EXPECT_EQ(first_different_row(view(other), view(points), 2), 1U);
  EXPECT_EQ(first_different_row(view(points), view(other), 2), 1U);
}

}  // namespace
}  // namespace delray::delaunay
