// Location and nearest vertices against looking at all.
#include "delaunay/query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "delaunay/generate.h"
#include "delaunay/predicates.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay {
namespace {

bool contains(const Query& query, std::size_t simplex, const glm::dvec3& q) {
  const std::size_t corners = static_cast<std::size_t>(query.triangulation().dim) + 1;
  for (std::size_t k = 0; k < corners; ++k) {
    std::array<glm::dvec3, 4> p{};
    for (std::size_t i = 0; i < corners; ++i) {
      p[i] = query.position(query.triangulation().vertices[simplex * corners + i]);
    }
    p[k] = q;
    const int side = corners == 3 ? orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y})
                                  : orient3d(p[0], p[1], p[2], p[3]);
    if (side < 0) return false;
  }
  return true;
}

void expect_right(const std::vector<glm::dvec3>& points, const Triangulation& triangulation,
                  std::uint64_t seed) {
  const Query query(view(points), triangulation);
  std::mt19937_64 random(seed);
  std::uint32_t near = Query::kNone;
  for (int round = 0; round < 60; ++round) {
    glm::dvec3 q = points[random() % points.size()];
    if (round % 3 != 0) {
      q = 0.5 * (q + points[random() % points.size()]);
      if (round % 3 == 1) q += 0.1 * (q - points[random() % points.size()]);
    }
    if (triangulation.dim == 2) q.z = 0;
    bool covered = false;
    for (std::size_t t = 0; t < triangulation.size() && !covered; ++t) {
      covered = contains(query, t, q);
    }
    for (const std::uint32_t found : {query.locate(q), query.locate(q, near)}) {
      ASSERT_EQ(found != Query::kNone, covered);
      if (covered) {
        EXPECT_TRUE(contains(query, found, q));
        near = found;
      }
    }
    const auto distance = [&](std::uint32_t row) {
      const glm::dvec3 d = query.position(row) - q;
      return glm::dot(d, d);
    };
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t row = 0; row < points.size(); ++row) least = std::min(least, distance(row));
    EXPECT_EQ(distance(query.nearest(q)), least);
  }
}

TEST(Query, LocatesAndFindsTheNearestInThePlane) {
  for (const char* kind : {"uniform", "grid", "cluster", "arc", "collinear", "duplicates", "ulp"}) {
    for (const std::size_t n : {1, 3, 40, 500}) {
      SCOPED_TRACE(kind);
      const auto points = generate_points(kind, n, 2, n).positions;
      expect_right(points, triangulate(view(points)).triangulation, n);
    }
  }
}

TEST(Query, LocatesAndFindsTheNearestInSpace) {
  for (const char* kind : {"uniform", "grid", "sphere", "cluster", "coplanar", "duplicates"}) {
    for (const std::size_t n : {1, 4, 22, 200}) {
      SCOPED_TRACE(kind);
      const auto points = generate_points(kind, n, 3, 5).positions;
      Options options;
      options.dim = 3;
      expect_right(points, triangulate(view(points), options).triangulation, 6);
    }
  }
}

TEST(Query, KnowsNothingOfNoPoints) {
  const std::vector<glm::dvec3> points;
  const Triangulation none;
  const Query query(view(points), none);
  EXPECT_EQ(query.locate({0, 0, 0}), Query::kNone);
  EXPECT_EQ(query.nearest({0, 0, 0}), Query::kNone);
}

}  // namespace
}  // namespace delray::delaunay
