#include <gtest/gtest.h>

#include <numeric>

#include "scenes/geometry/split.h"

namespace delray::scenes::internal {
namespace {

TEST(Split, TheFirstLabelKeepsTheVertexAndOthersGetCopies) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.uvs = {{0, 0}, {0, 1}, {0, 2}};
  mesh.uvs2 = {{1, 0}, {1, 1}, {1, 2}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}, {0, 1, 2}, {1, 0, 2}};
  const std::vector<std::uint32_t> labels = {5, 7, 7, 8, 7, 5, 0xFFFFFFFF, 3, 7, 3, 5, 8};
  split_vertices(mesh, labels);
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 1, 0}, {4, 5, 2}, {5, 0, 3}}));
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{
                                {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {0, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(mesh.uvs[5], glm::vec2(0, 1));
  ASSERT_EQ(mesh.uvs2.size(), 6U);
  EXPECT_EQ(mesh.uvs2[5], glm::vec2(1, 1));
  EXPECT_TRUE(mesh.normals.empty());
}

// Comparing each corner of the vertex with each label it has had would take a million times a
// million steps.
TEST(Split, AVertexMayHaveAMillionLabels) {
  constexpr std::uint32_t kTriangles = 1'000'000;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(kTriangles, {0, 1, 2});
  std::vector<std::uint32_t> labels(3 * kTriangles);
  std::iota(labels.begin(), labels.end(), 0U);
  split_vertices(mesh, labels);
  EXPECT_EQ(mesh.positions.size(), 3U * kTriangles);
  EXPECT_EQ(mesh.triangles[1], glm::uvec3(3, 4, 5));
  EXPECT_EQ(mesh.triangles.back().z, 3 * kTriangles - 1);
}

}  // namespace
}  // namespace delray::scenes::internal
