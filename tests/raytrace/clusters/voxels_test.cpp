// Equal voxels: disjoint but for rounding, each with all that reaches into it.
#include "raytrace/clusters/voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "comm/threads.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

struct Instances {
  explicit Instances(const scenes::Scene& scene)
      : shader(shading::make_shader(scene)),
        bounds(scenes::bounds(scene)),
        instances(make_instances(scene, shader, true)) {}
  shading::Shader shader;
  geometry::Box3 bounds;
  std::vector<GeometryInstance> instances;
};

TEST(Voxels, AreEqualCubesThatCoverTheScene) {
  const VoxelGrid grid = voxel_grid({{-1, 0, 2}, {7, 2, 3}}, 1'000'000, 4);
  EXPECT_EQ(grid.cells, glm::ivec3(16, 4, 2));
  EXPECT_DOUBLE_EQ(grid.side, 0.5);
  for (std::uint32_t i = 0; i < grid.count(); ++i) {
    const geometry::Box3 box = grid.box(i);
    EXPECT_EQ(grid.number(grid.cell_of(box.centre())), i);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(box.size()[k], 0.5, 1e-4);
  }
  EXPECT_EQ(grid.cell_of({-9, 9, std::nanf("")}), glm::ivec3(0, 3, 0));
  EXPECT_EQ(voxel_grid({}, 10, 3).count(), 1U);
  EXPECT_EQ(voxel_grid({{1, 1, 1}, {1, 1, 1}}, 10, 3).count(), 1U);
  EXPECT_EQ(voxel_grid({{0, 0, 0}, {1, 1, 1}}, 10, 3).count(), 1U);
}

TEST(Voxels, ATriangleReachesIntoABoxThatItPassesThroughOnly) {
  const geometry::Box3 box{{0, 0, 0}, {1, 1, 1}};
  const glm::vec3 around[3] = {{-10, 0.5F, -10}, {10, 0.5F, -10}, {0, 0.5F, 20}};
  EXPECT_TRUE(reaches_into(around, box));
  // Its box overlaps, it does not: it passes the corner.
  const glm::vec3 beside[3] = {{2.5F, -0.1F, 0}, {-0.1F, 2.5F, 0}, {3, 3, 1}};
  EXPECT_FALSE(reaches_into(beside, box));
  const glm::vec3 touching[3] = {{1, 0.5F, 0.5F}, {2, 0.5F, 0.5F}, {2, 0.6F, 0.5F}};
  EXPECT_TRUE(reaches_into(touching, box));
}

// Every point of every triangle is in a voxel that has the triangle, within its boxes.
TEST(Voxels, HaveAllThatReachesIntoThem) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  const scenes::Scene scene = scenes::generate("gen:terrain:3000");
  const Instances all(scene);
  const std::uint64_t count = stored_triangles(all.instances);
  const VoxelGrid grid = voxel_grid(all.bounds, 50'000, 2);
  ASSERT_GT(grid.count(), 20U);
  std::map<std::uint32_t, std::vector<geometry::Box3>> boxes;
  std::map<std::uint32_t, std::set<std::uint32_t>> triangles;
  std::uint64_t copies = 0;
  for (Voxel& voxel : cut_voxels(all.instances, 0, count, grid, 100)) {
    voxel.data.clip = grid.box(voxel.number);
    boxes[voxel.number] = boxes_of(voxel.data);
    copies += voxel.data.triangles();
    ASSERT_EQ(voxel.data.pieces.size(), 1U);
    for (const std::uint32_t t : voxel.data.pieces[0].triangles) triangles[voxel.number].insert(t);
    for (const geometry::Box3& box : boxes[voxel.number])
      for (int k = 0; k < 3; ++k) EXPECT_LT(box.size()[k], grid.side * 1.001);
  }
  EXPECT_GT(copies, count);  // those at borders are in several
  EXPECT_LT(copies, 2 * count);
  const scenes::Mesh& mesh = *all.instances[0].mesh;
  const glm::vec3* const positions = all.instances[0].positions;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    float u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const glm::uvec3 c = mesh.triangles[t];
    const glm::vec3 point = positions[c.x] * (1 - u - v) + positions[c.y] * u + positions[c.z] * v;
    const std::uint32_t voxel = grid.number(grid.cell_of(point));
    EXPECT_TRUE(triangles[voxel].contains(t)) << t;
    EXPECT_TRUE(std::ranges::any_of(boxes[voxel], [&](const geometry::Box3& box) {
      return glm::all(glm::lessThanEqual(box.low, point)) &&
             glm::all(glm::greaterThanEqual(box.high, point));
    })) << t;
  }
}

// A shadow ray that passes a surface passes it once.
TEST(Voxels, HaveWhatIsSeenThroughOnce) {
  scenes::Scene scene;
  add(scene, sphere(20)).alpha = scenes::Material::Alpha::blend;
  scene.materials[0].base_colour.a = 0.5F;
  const Instances all(scene);
  const std::uint64_t count = stored_triangles(all.instances);
  std::uint64_t copies = 0;
  for (const Voxel& voxel :
       cut_voxels(all.instances, 0, count, voxel_grid(all.bounds, 100'000, 4), 100))
    copies += voxel.data.triangles();
  EXPECT_EQ(copies, count);
}

// Parts of one voxel from several ranks come together, on ranks that chance chooses.
TEST(Voxels, AreDealtWhole) {
  const scenes::Scene scene = scenes::generate("gen:terrain:3000");
  const Instances all(scene);
  const std::uint64_t count = stored_triangles(all.instances);
  const VoxelGrid grid = voxel_grid(all.bounds, 50'000, 3);
  const std::size_t voxels = cut_voxels(all.instances, 0, count, grid, 100).size();
  std::vector<std::vector<ClusterData>> dealt(3);
  comm::run_threads(3, 1, [&](comm::Communicator& communicator) {
    const auto rank = static_cast<std::uint64_t>(communicator.rank());
    dealt[rank] = deal_voxels(
        communicator,
        cut_voxels(all.instances, count * rank / 3, count * (rank + 1) / 3, grid, 100), grid, 1);
  });
  std::size_t sum = 0;
  for (const auto& mine : dealt) {
    sum += mine.size();
    EXPECT_GT(mine.size(), voxels / 6);
    for (const ClusterData& data : mine) {
      EXPECT_FALSE(data.clip.empty());
      for (const GeometryInstance& instance : data.instances)
        EXPECT_LT(instance.mesh_number, data.pieces.size());
    }
  }
  EXPECT_EQ(sum, voxels);
}

}  // namespace
}  // namespace delray::raytrace
