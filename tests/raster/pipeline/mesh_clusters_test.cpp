#include "raster/pipeline/mesh_clusters.h"

#include <gtest/gtest.h>

#include <random>

#include "raster/pipeline/set_up.h"
#include "scenes/generate.h"

namespace delray::raster {
namespace {

void expect_clusters(const scenes::Mesh& mesh, const MeshClusters& clusters) {
  std::uint32_t next = 0;
  for (const auto& block : clusters.blocks) {
    ASSERT_NE(block, nullptr);
    ASSERT_EQ(next % kBlockTriangles, 0U);
    for (std::uint32_t part = 0; part < block->clusters.size(); ++part) {
      const MeshCluster& cluster = block->clusters[part];
      ASSERT_EQ(cluster.first, next);
      ASSERT_GT(cluster.count, 0U);
      ASSERT_LE(cluster.count, kClusterTriangles);
      ASSERT_LE(cluster.vertices, kClusterVertices);
      const std::span<const std::uint32_t> vertices = block->vertices_of(cluster);
      for (std::uint32_t place = 0; place < cluster.count; ++place, ++next) {
        EXPECT_EQ(part_with(*block, next), part);
        const LocalCorners corners = corners_at(*block, cluster, place);
        const glm::uvec3& t = mesh.triangles[next];
        ASSERT_EQ(glm::uvec3(vertices[corners.a], vertices[corners.b], vertices[corners.c]), t);
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        for (const glm::dvec3& p : {a, b, c}) {
          EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::dvec3(cluster.box.low), p)));
          EXPECT_TRUE(glm::all(glm::lessThanEqual(p, glm::dvec3(cluster.box.high))));
        }
        if (!(cluster.cosine > 0) || a == b || b == c || c == a) continue;
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        EXPECT_GE(glm::dot(normal, glm::dvec3(cluster.axis)), cluster.cosine);
        EXPECT_GE(glm::length(glm::cross(b - a, c - a)), cluster.least_height * glm::length(b - a));
      }
    }
  }
  EXPECT_EQ(next, mesh.triangles.size());
}

TEST(MeshClusters, CoverTheMeshInOrder) {
  for (const char* name : {"gen:terrain:150000", "gen:field:30000", "gen:city:3000"}) {
    for (const scenes::Mesh& mesh : scenes::generate(name).meshes) {
      MeshClusters clusters;
      clusters.make(mesh, 0, static_cast<std::uint32_t>(mesh.triangles.size()));
      expect_clusters(mesh, clusters);
    }
  }
}

TEST(MeshClusters, MostTrianglesOfASmoothMeshAreInClustersWithCones) {
  const scenes::Scene scene = scenes::generate("gen:terrain:20000");
  MeshClusters clusters;
  clusters.make(scene.meshes[0], 0, 20000);
  std::size_t cones = 0;
  for (const MeshCluster& cluster : clusters.blocks[0]->clusters) cones += cluster.cosine > 0;
  EXPECT_GT(cones, clusters.blocks[0]->clusters.size() * 3 / 4);
}

TEST(MeshClusters, TrianglesWithoutSharedVerticesMakeSmallerClusters) {
  std::mt19937 random(1);
  scenes::Mesh mesh;
  mesh.positions.resize(900);
  for (glm::vec3& p : mesh.positions) p = {random() % 100, random() % 100, random() % 100};
  for (std::uint32_t v = 0; v < 900; v += 3) mesh.triangles.emplace_back(v, v + 1, v + 2);
  MeshClusters clusters;
  clusters.make(mesh, 0, 300);
  expect_clusters(mesh, clusters);
  EXPECT_EQ(clusters.blocks[0]->clusters[0].count, kClusterVertices / 3);
}

TEST(MeshClusters, OnlyWhatIsAskedForIsMade) {
  scenes::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(3 * kBlockTriangles + 5, {0, 1, 2});
  MeshClusters clusters;
  clusters.make(mesh, kBlockTriangles + 7, kBlockTriangles);
  ASSERT_EQ(clusters.blocks.size(), 4U);
  EXPECT_EQ(clusters.blocks[0], nullptr);
  EXPECT_NE(clusters.blocks[1], nullptr);
  EXPECT_NE(clusters.blocks[2], nullptr);
  EXPECT_EQ(clusters.blocks[3], nullptr);
  const ClusterBlock* const kept = clusters.blocks[1].get();
  clusters.make(mesh, 0, static_cast<std::uint32_t>(mesh.triangles.size()));
  EXPECT_EQ(clusters.blocks[1].get(), kept);
  expect_clusters(mesh, clusters);
}

TEST(MeshClusters, PositionsThatAreNotFiniteMakeTheBoxInfinite) {
  scenes::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, std::nanf(""), 0}};
  mesh.triangles = {{0, 1, 2}};
  MeshClusters clusters;
  clusters.make(mesh, 0, 1);
  const MeshCluster& cluster = clusters.blocks[0]->clusters[0];
  EXPECT_EQ(cluster.box.low.x, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(cluster.box.high.y, std::numeric_limits<float>::infinity());
  EXPECT_LT(cluster.cosine, 0);
}

}  // namespace
}  // namespace delray::raster
