#include "scenes/scene.h"

#include <gtest/gtest.h>

#include "parallel/arena.h"
#include "scenes/describe.h"
#include "scenes/generate.h"

namespace delray::scenes {
namespace {

Scene two_placements() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.instances.resize(2);
  // A quarter turn about z, then a shift.
  scene.instances[1].transform = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {10, 0, 0}};
  return scene;
}

TEST(Scene, CountsEveryInstance) {
  const Scene scene = two_placements();
  EXPECT_EQ(triangle_count(scene), 4U);
  EXPECT_EQ(vertex_count(scene), 8U);
  EXPECT_EQ(first_primitives(scene), (std::vector<std::uint64_t>{0, 2, 4}));
}

TEST(Scene, BoundsAreThoseOfTransformedVertices) {
  const Scene scene = two_placements();
  EXPECT_EQ(bounds(scene), (geometry::Box3{{0, 0, 0}, {10, 2, 3}}));
  EXPECT_TRUE(bounds(Scene{}).empty());
}

TEST(Scene, BoundsDoNotDependOnThreads) {
  const Scene scene = generate("gen:field:200000");
  parallel::Arena one(1), three(3);
  EXPECT_EQ(one.execute([&] { return bounds(scene); }),
            three.execute([&] { return bounds(scene); }));
}

TEST(Describe, CountsWhatIsThere) {
  Scene scene = two_placements();
  scene.materials.resize(1);
  scene.materials[0].name = "brick";
  scene.textures.push_back({"wall.png", 2, 1, {{}, {}}});
  scene.lights.resize(3);
  scene.lights[0].kind = Light::Kind::area;
  const Description d = describe(scene);
  EXPECT_EQ(d.meshes, 1U);
  EXPECT_EQ(d.instances, 2U);
  EXPECT_EQ(d.triangles, 4U);
  EXPECT_EQ(d.stored_triangles, 2U);
  EXPECT_EQ(d.vertices, 8U);
  EXPECT_EQ(d.stored_vertices, 4U);
  EXPECT_EQ(d.materials, std::vector<std::string>{"brick"});
  ASSERT_EQ(d.textures.size(), 1U);
  EXPECT_EQ(d.textures[0].width, 2);
  EXPECT_EQ(d.area_lights, 1U);
  EXPECT_EQ(d.directional_lights, 2U);
  EXPECT_EQ(d.bytes, 4 * 12 + 2 * 12 + 2 * 4U);
  EXPECT_EQ(d.bounds, bounds(scene));
  EXPECT_FALSE(d.has_normals);
}

}  // namespace
}  // namespace delray::scenes
