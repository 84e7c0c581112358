// Numbers of corners and simplices.
#include "delaunay/mesh/mesh.h"

#include <gtest/gtest.h>

namespace delray::delaunay {
namespace {

TEST(Mesh, CornersOfATriangleGoRound) {
  for (const SimplexNumber t : {0U, 1U, 7U, 1000000U}) {
    for (unsigned k = 0; k < 3; ++k) {
      EXPECT_EQ(next_corner(corner_of(t, k)), corner_of(t, (k + 1) % 3));
      EXPECT_EQ(previous_corner(corner_of(t, k)), corner_of(t, (k + 2) % 3));
      EXPECT_EQ(simplex_of(corner_of(t, k)), t);
    }
  }
}

template <int D>
void expect_corners_are_apart() {
  constexpr unsigned kSimplices = 5;
  Mesh<D> mesh(kSimplices);
  EXPECT_EQ(mesh.size(), kSimplices);
  for (SimplexNumber t = 0; t < kSimplices; ++t) {
    for (unsigned k = 0; k <= D; ++k) mesh.set_vertex(corner_of(t, k), 10 * t + k);
  }
  for (SimplexNumber t = 0; t + 1 < kSimplices; t += 2) {
    for (unsigned k = 0; k <= D; ++k) mesh.link(corner_of(t, k), corner_of(t + 1, D - k));
  }
  for (SimplexNumber t = 0; t < kSimplices; ++t) {
    for (unsigned k = 0; k <= D; ++k) EXPECT_EQ(mesh.vertex(corner_of(t, k)), 10 * t + k);
  }
  for (SimplexNumber t = 0; t + 1 < kSimplices; t += 2) {
    for (unsigned k = 0; k <= D; ++k) {
      EXPECT_EQ(mesh.neighbour(corner_of(t, k)), corner_of(t + 1, D - k));
      EXPECT_EQ(mesh.neighbour(corner_of(t + 1, D - k)), corner_of(t, k));
    }
  }
}

TEST(Mesh, CornersAreApartIn2D) { expect_corners_are_apart<2>(); }
TEST(Mesh, CornersAreApartIn3D) { expect_corners_are_apart<3>(); }

}  // namespace
}  // namespace delray::delaunay
