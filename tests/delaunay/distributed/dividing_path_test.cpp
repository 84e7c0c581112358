#include "delaunay/distributed/dividing_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "delaunay/distributed/areas.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

std::vector<RowPoint> with_rows(const Points& positions) {
  std::vector<RowPoint> points;
  for (const glm::dvec2& p : positions) points.push_back({glm::dvec3(p, 0), points.size()});
  return distinct_points(points, 2);
}

// The edges of a path are edges of the triangulation, and those of its triangles that lie on one
// side are the ones of the points on that side.
TEST(DividingPath, DividesTheTriangulation) {
  std::mt19937_64 random(3);
  for (const HardPoints& set : hard_points()) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const std::vector<RowPoint> points = with_rows(set.make(12 * seed, seed));
      const CutLine line{static_cast<int>(seed % 2),
                         points[random() % points.size()].position[static_cast<int>(seed % 2)]};
      SCOPED_TRACE(set.name + ", seed " + std::to_string(seed));
      const DividingPath path(line, lower_hull(line, points));
      const auto all = triangles_between(points, {}, {}, {});
      std::set<std::set<std::uint64_t>> edges, whole, parts;
      for (std::size_t i = 0; i < all.size(); i += 3) {
        const std::uint64_t r[3] = {points[all[i]].row, points[all[i + 1]].row,
                                    points[all[i + 2]].row};
        whole.insert({r[0], r[1], r[2]});
        for (int k = 0; k < 3; ++k) edges.insert({r[k], r[(k + 1) % 3]});
      }
      for (std::size_t i = 0; !all.empty() && i + 1 < path.vertices().size(); ++i) {
        EXPECT_TRUE(edges.contains({path.vertices()[i].row, path.vertices()[i + 1].row}));
      }
      for (const int side : {-1, 1}) {
        std::vector<RowPoint> part;
        for (const RowPoint& point : points) {
          if (path.side_of(point.position) != -side) part.push_back(point);
        }
        const auto kept = triangles_between(part, std::span(&path, 1), std::span(&side, 1), {});
        for (std::size_t i = 0; i < kept.size(); i += 3) {
          const bool is_new =
              parts.insert({part[kept[i]].row, part[kept[i + 1]].row, part[kept[i + 2]].row})
                  .second;
          EXPECT_TRUE(is_new);
        }
      }
      EXPECT_EQ(parts, whole);
    }
  }
}

// Of the points of several ranks the path is that of their paths.
TEST(DividingPath, IsThatOfThePathsOfParts) {
  for (const HardPoints& set : hard_points()) {
    const std::vector<RowPoint> points = with_rows(set.make(60, 9));
    const CutLine line{0, points[points.size() / 2].position.x};
    std::vector<RowPoint> hulls;
    for (std::size_t part = 0; part < 4; ++part) {
      std::vector<RowPoint> some;
      for (std::size_t i = part; i < points.size(); i += 4) some.push_back(points[i]);
      const auto hull = lower_hull(line, some);
      hulls.insert(hulls.end(), hull.begin(), hull.end());
    }
    const auto whole = lower_hull(line, points), merged = lower_hull(line, hulls);
    EXPECT_TRUE(std::ranges::equal(whole, merged, {}, &RowPoint::row, &RowPoint::row)) << set.name;
  }
}

// The lowest of three in one line along the paraboloid, and ties of points on one circle about the
// line: the last in lexicographic order is raised most.
TEST(DividingPath, TurnsTiesByThePerturbation) {
  const CutLine line{0, 0};
  EXPECT_EQ(projected_turn(line, {0, -1}, {0, 0}, {0, 1}), 1);
  // On the unit circle about the origin, so on one line when projected: (-1, 0) is raised least, so
  // the path takes it.
  EXPECT_EQ(projected_turn(line, {0, -1}, {-1, 0}, {0, 1}), 1);
  EXPECT_EQ(projected_turn(line, {0, -1}, {1, 0}, {0, 1}), -1);
  EXPECT_TRUE(is_lifted_less(line, {-1, 0}, {1, 0}));
  EXPECT_FALSE(is_lifted_less(line, {1, 0}, {-1, 0}));
  EXPECT_TRUE(is_lifted_less(line, {0.5, 0}, {-1, 0}));
}

}  // namespace
}  // namespace delray::delaunay
