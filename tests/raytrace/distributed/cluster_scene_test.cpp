// Scenes whose clusters come and go: the hits of a scene that was made of those that are left.
#include "raytrace/distributed/cluster_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// Spheres, some of them of one mesh, one that can be seen through.
scenes::Scene spheres() {
  scenes::Scene scene;
  for (int i = 0; i < 4; ++i) {
    const float x = 1.2F * static_cast<float>(i);
    add(scene, sphere(10 + i), placed(1.0F, {x, 0, 0}));
    scene.instances.push_back({static_cast<std::uint32_t>(i), placed(0.6F, {x, 2, 0})});
  }
  scenes::Material& glassy = add(scene, sphere(12), placed(1.0F, {2, -2, 0}));
  glassy.alpha = scenes::Material::Alpha::blend;
  glassy.base_colour.a = 0.5F;
  return scene;
}

using Clusters = std::vector<std::shared_ptr<const Cluster>>;

Clusters clusters_of(const scenes::Scene& scene, const shading::Shader& shader) {
  const std::vector<GeometryInstance> instances = make_instances(scene, shader, true);
  Clusters clusters;
  for (ClusterData& data : cut_clusters(instances, 0, stored_triangles(instances), 50))
    clusters.push_back(
        std::make_shared<const Cluster>(std::move(data), shader, least_alphas(shader)));
  return clusters;
}

// What rays hit in the whole scene, and how many layers light passes.
std::vector<std::string> hits(const EmbreeScene& embree, std::span<const GeometryNumbers> numbers) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(-1.0F, 5.0F), y(-3.0F, 3.0F), slant(0.01F, 0.3F);
  std::vector<std::string> all;
  for (int i = 0; i < 400; ++i) {
    Ray ray{};
    ray.origin_x = x(random), ray.origin_y = y(random), ray.origin_z = 5;
    ray.direction_x = slant(random), ray.direction_y = slant(random), ray.direction_z = -1;
    ray.far = std::numeric_limits<float>::infinity();
    ray.mask = 0xFFFFFFFFU;
    ray.triangle = ray.geometry = ray.instance = kMiss;
    Ray shadow = ray;
    SeeThrough passed;
    std::string result = embree.occluded(shadow, passed) ? "dark" : "lit";
    result += ' ' + std::to_string(passed.count);
    embree.intersect(ray);
    if (ray.triangle != kMiss) {
      const Hit hit = in_whole_scene(hit_of(ray), numbers);
      result += ' ' + std::to_string(hit.instance) + ' ' + std::to_string(hit.triangle) + ' ' +
                std::to_string(hit.distance);
    }
    all.push_back(result);
  }
  return all;
}

std::vector<std::string> hits(const ClusterScene& scene, const shading::Shader& shader) {
  const LocalScene local = scene.local(shader);
  return hits(local.embree, local.numbers);
}

TEST(ClusterScene, ChangesToWhatASceneOfTheSameClustersIs) {
  const scenes::Scene scene = spheres();
  const shading::Shader shader = shading::make_shader(scene);
  const Clusters clusters = clusters_of(scene, shader);
  ASSERT_GT(clusters.size(), 20U);
  const std::vector<GeometryInstance> instances = make_instances(scene, shader, true);
  const std::vector<std::string> whole = hits(EmbreeScene(instances, {}), {});
  for (const bool changing : {true, false}) {
    BuildOptions options;
    options.changing = changing;
    const EmbreeDevice device(options);
    ClusterScene scene_in_change({}, options, device);
    std::mt19937 random(11);
    std::vector<std::string> before;
    for (int turn = 0; turn < 8; ++turn) {
      Clusters some;
      for (const std::shared_ptr<const Cluster>& cluster : clusters)
        if (turn == 4 || random() % 3 != 0) some.push_back(cluster);
      if (turn == 2) some.clear();
      scene_in_change.change(some);
      const std::vector<std::string> after = hits(scene_in_change, shader);
      EXPECT_NE(after, before) << turn;
      if (turn == 4) {
        EXPECT_EQ(after, whole);
      }
      EXPECT_EQ(after, hits(ClusterScene(some, {}, device), shader)) << turn;
      before = after;
    }
  }
}

// What has gone gives its memory back, but for some that Embree keeps.
TEST(ClusterScene, TakesNoMoreMemoryHoweverOftenItChanges) {
  const scenes::Scene scene = spheres();
  const shading::Shader shader = shading::make_shader(scene);
  const Clusters clusters = clusters_of(scene, shader);
  const Clusters half(clusters.begin(), clusters.begin() + static_cast<long>(clusters.size() / 2));
  BuildOptions options;
  options.changing = true;
  const EmbreeDevice device(options);
  ClusterScene changing(clusters, options, device);
  const std::uint64_t whole = changing.bytes();
  for (int turn = 0; turn < 20; ++turn) {
    changing.change(half);
    EXPECT_LT(changing.bytes(), whole) << turn;
    changing.change(clusters);
    EXPECT_LT(changing.bytes(), whole + whole / 4) << turn;
  }
}

}  // namespace
}  // namespace delray::raytrace
