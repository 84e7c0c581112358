#include "scenes/geometry/weld.h"

#include <gtest/gtest.h>

namespace delray::scenes::internal {
namespace {

TEST(Weld, VerticesBecomeOneOnlyIfAllTheirAttributesAreEqual) {
  Mesh mesh;
  mesh.positions.assign(6, {1, 2, 3});
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs.assign(6, {0.5F, 0.5F});
  mesh.uvs2.assign(6, {0.25F, 0.5F});
  mesh.normals[1] = {0, 1, 0};
  mesh.uvs[2] = {0.5F, 0.75F};
  mesh.uvs2[3] = {0.25F, 0.75F};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(weld(mesh), (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 0}));
  EXPECT_EQ(mesh.positions.size(), 4U);
  ASSERT_EQ(mesh.uvs2.size(), 4U);
  EXPECT_EQ(mesh.uvs2[3], glm::vec2(0.25F, 0.75F));
  EXPECT_EQ(mesh.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 0, 0}}));
}

}  // namespace
}  // namespace delray::scenes::internal
