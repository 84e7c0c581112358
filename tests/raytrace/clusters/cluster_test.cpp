// Clusters know which of their triangles nobody sees through, and their boxes hold all of them.
#include "raytrace/clusters/cluster.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// The clusters of a scene.
std::vector<ClusterData> clusters_of(const scenes::Scene& scene, std::uint32_t most) {
  const shading::Shader shader = shading::make_shader(scene);
  const std::vector<GeometryInstance> instances = make_instances(scene, shader, true);
  return cut_clusters(instances, 0, stored_triangles(instances), most);
}

scenes::Scene blended_sphere(float alpha) {
  scenes::Scene scene;
  scenes::Material& material = add(scene, sphere(40));
  material.alpha = scenes::Material::Alpha::blend;
  material.base_colour.a = alpha;
  return scene;
}

TEST(Cluster, KnowsItsOpaqueTriangles) {
  for (const float alpha : {1.0F, 0.5F}) {
    const scenes::Scene scene = blended_sphere(alpha);
    const shading::Shader shader = shading::make_shader(scene);
    std::size_t clusters = 0;
    for (ClusterData& data : clusters_of(scene, 500)) {
      const std::uint64_t triangles = data.triangles();
      const Cluster cluster(std::move(data), shader, least_alphas(shader));
      ASSERT_EQ(cluster.instances().size(), 1U);
      const auto& opaque = cluster.instances()[0].opaque;
      ASSERT_EQ(opaque != nullptr, alpha == 1.0F);
      for (std::uint64_t i = 0; opaque != nullptr && i < triangles; ++i) {
        EXPECT_EQ((*opaque)[i / 64] >> (i % 64) & 1, 1U) << i;
      }
      ++clusters;
    }
    EXPECT_GT(clusters, 4U);
  }
}

TEST(Cluster, EveryTriangleIsInABoxAndBoxesAreSeveral) {
  const scenes::Scene scene = blended_sphere(1.0F);
  const std::vector<ClusterData> clusters = clusters_of(scene, 1 << 14);
  ASSERT_EQ(clusters.size(), 1U);
  const std::vector<geometry::Box3> boxes = boxes_of(clusters[0]);
  EXPECT_GT(boxes.size(), 4U);
  const scenes::Mesh& mesh = clusters[0].pieces[0].mesh;
  for (const glm::uvec3& corners : mesh.triangles) {
    EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const geometry::Box3& box) {
      geometry::Box3 more = box;
      for (int k = 0; k < 3; ++k) more.include(mesh.positions[corners[k]]);
      return more == box;
    }));
  }
}

}  // namespace
}  // namespace delray::raytrace
