// Walks from every simplex, and meshes that stay linked.
#include "delaunay/insertion/walk.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/mesh/access.h"
#include "delaunay/predicates.h"
#include "tests/delaunay/hard_points.h"

namespace delray::delaunay {
namespace {

// A triangle with its three ghosts, then points inserted one by one where the walk puts them.
class Walk : public testing::Test {
 protected:
  Walk() {
    points_ = {{0, 0}, {4, 0}, {0, 4}};
    std::mt19937_64 random(7);
    for (int i = 0; i < 300; ++i) {
      points_.emplace_back(static_cast<double>(random() % 12), static_cast<double>(random() % 12));
    }
    for (unsigned k = 0; k < 3; ++k) {
      mesh_.set_vertex(corner_of(0, k), k);
      mesh_.set_vertex(corner_of(1 + k, 0), (k + 2) % 3);
      mesh_.set_vertex(corner_of(1 + k, 1), (k + 1) % 3);
      mesh_.set_vertex(corner_of(1 + k, 2), kInfiniteVertex);
      mesh_.link(corner_of(0, k), corner_of(1 + k, 2));
      mesh_.link(corner_of(1 + k, 1), corner_of(1 + (k + 1) % 3, 0));
    }
    for (VertexNumber v = 3; v < points_.size(); ++v) {
      const Place place = walk(mesh_, points_, 0, points_[v], random_);
      if (place.equal != kInfiniteVertex) continue;
      internal::subdivide(mesh_, place.simplex, v, access_, suspects_);
      internal::legalize(mesh_, points_, access_, suspects_);
    }
  }

  glm::dvec2 point(CornerNumber corner) const { return points_[mesh_.vertex(corner)]; }

  Mesh<2> mesh_{700};
  std::vector<glm::dvec2> points_;
  internal::SoleAccess access_{4};
  std::vector<CornerNumber> suspects_;
  std::uint32_t random_ = 1;
};

TEST_F(Walk, MeshStaysLinkedBothWaysAndDelaunay) {
  for (SimplexNumber t = 0; t < access_.used(); ++t) {
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(t, k), beyond = mesh_.neighbour(corner);
      EXPECT_EQ(mesh_.neighbour(beyond), corner);
      EXPECT_EQ(mesh_.vertex(next_corner(corner)), mesh_.vertex(previous_corner(beyond)));
      EXPECT_EQ(mesh_.vertex(previous_corner(corner)), mesh_.vertex(next_corner(beyond)));
      if (mesh_.vertex(beyond) != kInfiniteVertex) {
        EXPECT_FALSE(conflict(mesh_, points_, t, point(beyond)));
      }
    }
  }
}

TEST_F(Walk, EndsAtThePointFromEverySimplex) {
  std::vector<glm::dvec2> targets = points_;
  for (int i = 0; i < 40; ++i) targets.emplace_back(0.37 * i - 2, 13 - 0.41 * i);
  for (SimplexNumber start = 0; start < access_.used(); start += 3) {
    for (const glm::dvec2& q : targets) {
      const Place place = walk(mesh_, points_, start, q, random_);
      if (mesh_.is_ghost(place.simplex)) {
        EXPECT_EQ(place.equal, kInfiniteVertex);
        EXPECT_TRUE(conflict(mesh_, points_, place.simplex, q));
        continue;
      }
      bool is_vertex = false;
      for (unsigned k = 0; k < 3; ++k) {
        const CornerNumber corner = corner_of(place.simplex, k);
        EXPECT_GE(orient2d(point(next_corner(corner)), point(previous_corner(corner)), q), 0);
        is_vertex |= point(corner) == q;
      }
      EXPECT_EQ(place.equal != kInfiniteVertex, is_vertex);
      if (is_vertex) {
        EXPECT_EQ(points_[place.equal], q);
      }
    }
  }
}

}  // namespace
}  // namespace delray::delaunay
