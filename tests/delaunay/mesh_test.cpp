#include "delaunay/mesh.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

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

// Large enough for memory that is mapped, and given back, by pages.
TEST(Mesh, TakeFiniteSkipsGhostsAndTheDead) {
  for (const SimplexNumber simplices : {0U, 5U, 300000U}) {
    Mesh<2> mesh(simplices);
    std::vector<VertexNumber> expected;
    for (SimplexNumber t = 0; t < simplices; ++t) {
      for (unsigned k = 0; k < 3; ++k) mesh.set_vertex(corner_of(t, k), 3 * t + k);
      if (t % 5 == 1) mesh.set_vertex(corner_of(t, t % 3), kInfiniteVertex);
      if (t % 5 == 2) mesh.set_vertex(corner_of(t, 0), kDeadVertex);
      EXPECT_EQ(mesh.is_ghost(t), t % 5 == 1);
      EXPECT_EQ(mesh.is_dead(t), t % 5 == 2);
      if (t % 5 == 1 || t % 5 == 2) continue;
      for (unsigned k = 0; k < 3; ++k) expected.push_back(3 * t + k);
    }
    const Array<VertexNumber> taken = std::move(mesh).take_finite();
    EXPECT_EQ(std::vector(taken.data(), taken.data() + taken.size()), expected);
  }
}

TEST(Mesh, PackFiniteSkipsGhostsAndTheDeadOfEachRange) {
  constexpr SimplexNumber kSimplices = 200000;
  Mesh<2> mesh(kSimplices);
  std::vector<VertexNumber> expected;
  for (SimplexNumber t = 0; t < kSimplices; ++t) {
    for (unsigned k = 0; k < 3; ++k) mesh.set_vertex(corner_of(t, k), 3 * t + k);
    if (t % 5 == 1) mesh.set_vertex(corner_of(t, t % 3), kInfiniteVertex);
    if (t % 5 == 2) mesh.set_vertex(corner_of(t, 0), kDeadVertex);
    if (t % 5 == 1 || t % 5 == 2) continue;
    for (unsigned k = 0; k < 3; ++k) expected.push_back(3 * t + k);
  }
  std::vector<VertexNumber> packed;
  std::size_t ghosts = 0;
  for (const auto& [first, last] : {std::pair(0U, 70001U), std::pair(70001U, kSimplices)}) {
    const Mesh<2>::Packed part = mesh.pack_finite(first, last);
    packed.insert(packed.end(), part.vertices.begin(), part.vertices.end());
    ghosts += part.ghosts;
  }
  EXPECT_EQ(packed, expected);
  EXPECT_EQ(ghosts, kSimplices / 5);
}

}  // namespace
}  // namespace delray::delaunay
