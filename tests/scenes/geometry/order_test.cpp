#include "scenes/geometry/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

namespace delray::scenes::internal {
namespace {

// A grid of n x n cells whose triangles and vertices come in any order; each vertex has attributes
// that tell it.
Mesh shuffled_grid(std::uint32_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> number((n + 1) * (n + 1));
  for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = i;
  std::shuffle(number.begin(), number.end(), random);
  Mesh mesh;
  mesh.positions.resize(number.size());
  mesh.uvs.resize(number.size());
  mesh.uvs2.resize(number.size());
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const std::uint32_t v = number[j * (n + 1) + i];
      mesh.positions[v] = {i, j, 0};
      mesh.uvs[v] = {i, j};
      mesh.uvs2[v] = {j, i};
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = j * (n + 1) + i;
      mesh.triangles.emplace_back(number[v], number[v + 1], number[v + n + 2]);
      mesh.triangles.emplace_back(number[v], number[v + n + 2], number[v + n + 1]);
    }
  }
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

using Corners = std::array<float, 6>;
std::vector<Corners> corners_of(const Mesh& mesh) {
  std::vector<Corners> corners;
  for (const glm::uvec3& t : mesh.triangles) {
    Corners c;
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(glm::vec2(mesh.positions[t[k]]), mesh.uvs[t[k]]);
      EXPECT_EQ(glm::vec2(mesh.uvs[t[k]].y, mesh.uvs[t[k]].x), mesh.uvs2[t[k]]);
      c[static_cast<std::size_t>(2 * k)] = mesh.positions[t[k]].x;
      c[static_cast<std::size_t>(2 * k + 1)] = mesh.positions[t[k]].y;
    }
    corners.push_back(c);
  }
  return corners;
}

double mean_side_of_runs(const Mesh& mesh) {
  double sum = 0;
  int runs = 0;
  for (std::size_t first = 0; first + 128 <= mesh.triangles.size(); first += 128, ++runs) {
    geometry::Box3 box;
    for (std::size_t t = first; t < first + 128; ++t)
      for (int k = 0; k < 3; ++k) box.include(mesh.positions[mesh.triangles[t][k]]);
    sum += 0.5 * (double{box.size().x} + box.size().y);
  }
  return sum / runs;
}

TEST(Order, BringsNeighboursTogetherAndKeepsEveryTriangle) {
  Mesh mesh = shuffled_grid(64, 1);
  std::vector<Corners> before = corners_of(mesh);
  EXPECT_GT(mean_side_of_runs(mesh), 50);
  order_for_locality(mesh);
  EXPECT_LT(mean_side_of_runs(mesh), 14);  // 64 cells are 8 x 8
  std::vector<Corners> after = corners_of(mesh);
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
  // Vertices are close to those before them, too.
  double sum = 0;
  for (std::size_t i = 1; i < mesh.positions.size(); ++i)
    sum += glm::distance(mesh.positions[i - 1], mesh.positions[i]);
  EXPECT_LT(sum / static_cast<double>(mesh.positions.size()), 4);
}

TEST(Order, NumbersVerticesAsTheyAreUsed) {
  Mesh mesh = shuffled_grid(150, 7);  // enough that several blocks are numbered at a time
  mesh.triangles[5].z = mesh.triangles[5].x;
  mesh.triangles[9].y = mesh.triangles[9].z = mesh.triangles[9].x;
  mesh.positions.emplace_back(1, 1, 1);
  mesh.positions.emplace_back(2, 2, 2);
  mesh.uvs.resize(mesh.positions.size());
  mesh.uvs2.resize(mesh.positions.size());
  order_for_locality(mesh);
  std::uint32_t used = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(t[k], used);
      used += t[k] == used ? 1 : 0;
    }
  }
  ASSERT_GE(mesh.positions.size(), used + 2);
  EXPECT_EQ(mesh.positions.end()[-2], glm::vec3(1, 1, 1));
  EXPECT_EQ(mesh.positions.end()[-1], glm::vec3(2, 2, 2));
}

TEST(Order, IsTheSameTheSecondTime) {
  Mesh mesh = shuffled_grid(40, 2);
  order_for_locality(mesh);
  const Mesh once = mesh;
  order_for_locality(mesh);
  EXPECT_EQ(mesh.triangles, once.triangles);
  EXPECT_EQ(mesh.positions, once.positions);
}

TEST(Order, LeavesSmallMeshesAndVerticesWithoutTrianglesAlone) {
  Mesh small = shuffled_grid(10, 3);
  const Mesh before = small;
  order_for_locality(small);
  EXPECT_EQ(small.triangles, before.triangles);
  Mesh mesh = shuffled_grid(40, 4);
  mesh.positions.insert(mesh.positions.end(), 5, glm::vec3(7, 7, 7));
  mesh.uvs.insert(mesh.uvs.end(), 5, glm::vec2(7, 7));
  mesh.uvs2.insert(mesh.uvs2.end(), 5, glm::vec2(7, 7));
  order_for_locality(mesh);
  ASSERT_EQ(mesh.positions.size(), 41U * 41 + 5);
  EXPECT_EQ(mesh.positions.back(), glm::vec3(7, 7, 7));
}

TEST(Order, SurvivesDegenerateMeshes) {
  Mesh flat = shuffled_grid(40, 5);
  for (glm::vec3& p : flat.positions) p = glm::vec3(3, 3, 3);
  order_for_locality(flat);
  EXPECT_EQ(flat.triangles.size(), 3200U);
  for (const float wild : {std::numeric_limits<float>::quiet_NaN(), 3e38F, -3e38F}) {
    Mesh mesh = shuffled_grid(40, 6);
    mesh.positions[77] = {wild, -wild, 0};
    mesh.uvs[77] = {wild, -wild};
    order_for_locality(mesh);
    EXPECT_EQ(mesh.triangles.size(), 3200U);
  }
}

}  // namespace
}  // namespace delray::scenes::internal
