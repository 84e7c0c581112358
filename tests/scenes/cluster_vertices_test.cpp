#include "scenes/cluster_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "parallel/arena.h"
#include "scenes/generate.h"

namespace delray::scenes {
namespace {

using Place = std::tuple<float, float, float>;
Place place_of(const glm::vec3& p) { return {p.x, p.y, p.z}; }

// A square of side 1 in z = 0, of 2 n^2 triangles.
Mesh square(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      mesh.positions.emplace_back(static_cast<float>(x) / static_cast<float>(n),
                                  static_cast<float>(y) / static_cast<float>(n), 0);
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
      mesh.triangles.emplace_back(a, a + 1, b);
      mesh.triangles.emplace_back(a + 1, b + 1, b);
    }
  }
  return mesh;
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0});
  scene.materials.emplace_back();
  return scene;
}

float area_of(const Scene& scene) {
  float area = 0;
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3& a = mesh.positions[t.x];
      area += glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a)) / 2;
    }
  }
  return area;
}

TEST(ClusterVertices, ASquareStaysAlmostWholeWithFewTriangles) {
  const Scene whole = scene_of(square(300));
  for (const std::size_t most : {60'000, 40'000, 10'000, 2'000}) {
    const std::optional<Scene> coarse = cluster_vertices(whole, most);
    ASSERT_TRUE(coarse);
    const auto triangles = static_cast<double>(triangle_count(*coarse));
    EXPECT_LE(triangles, most);
    EXPECT_GT(triangles, most / 8);
    // Along the border a cube or so is missing.
    const double cubes = std::sqrt(triangles / 2);
    EXPECT_GT(area_of(*coarse), 1 - 4 / cubes) << most;
    EXPECT_LE(area_of(*coarse), 1.001) << most;
    for (const glm::uvec3& t : coarse->meshes[0].triangles) {
      const auto& p = coarse->meshes[0].positions;
      EXPECT_GE(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z, 0) << "turned over";
    }
  }
}

TEST(ClusterVertices, VerticesAreSomeOfTheSceneWithTheirAttributes) {
  Mesh mesh = square(60);
  for (const glm::vec3& p : mesh.positions) mesh.colours.emplace_back(p, 1);
  const std::optional<Scene> coarse = cluster_vertices(scene_of(mesh), 1'000);
  ASSERT_TRUE(coarse);
  std::set<Place> places;
  for (const glm::vec3& p : mesh.positions) places.insert(place_of(p));
  const Mesh& some = coarse->meshes[0];
  ASSERT_EQ(some.colours.size(), some.positions.size());
  for (std::size_t v = 0; v < some.positions.size(); ++v) {
    EXPECT_TRUE(places.contains(place_of(some.positions[v])));
    EXPECT_EQ(glm::vec3(some.colours[v]), some.positions[v]);
  }
}

TEST(ClusterVertices, IsTheSameForEveryNumberOfThreads) {
  const Scene whole = generate("gen:terrain:200000");
  std::vector<Scene> coarse;
  for (const int threads : {1, 2, 7}) {
    parallel::Arena arena(threads);
    coarse.push_back(arena.execute([&] { return cluster_vertices(whole, 20'000).value(); }));
  }
  for (const Scene& other : coarse) {
    EXPECT_EQ(other.meshes[0].positions, coarse[0].meshes[0].positions);
    EXPECT_EQ(other.meshes[0].triangles, coarse[0].meshes[0].triangles);
  }
}

TEST(ClusterVertices, InstancesAreWhereTheyWereAndAsFineAsTheLargestNeeds) {
  Scene whole = scene_of(square(300));
  for (int axis = 0; axis < 3; ++axis) whole.instances[0].transform[axis] *= 0.01F;
  const std::optional<Scene> small = cluster_vertices(whole, 1'000'000);
  ASSERT_TRUE(small) << "its size alone is nothing to go by";
  whole.instances.push_back({0, glm::mat4x3(glm::mat4(1))});
  const std::optional<Scene> both = cluster_vertices(whole, 1'000'000);
  ASSERT_TRUE(both);
  ASSERT_EQ(both->instances.size(), 2U);
  EXPECT_EQ(both->instances[0].transform, whole.instances[0].transform);
  ASSERT_EQ(both->meshes.size(), 1U);
  EXPECT_GT(both->meshes[0].triangles.size(), 40'000U);
  whole.meshes.push_back(square(300));  // no larger than two cubes
  whole.instances[0].mesh = 1;
  const std::optional<Scene> one = cluster_vertices(whole, 1'000'000);
  ASSERT_TRUE(one);
  EXPECT_LT(one->meshes[0].triangles.size(), 100U);
}

TEST(ClusterVertices, TexturesBecomeColoursOfVertices) {
  Mesh mesh = square(60);
  for (const glm::vec3& p : mesh.positions) mesh.uvs.emplace_back(p.x - 3, p.y + 5);
  Scene whole = scene_of(std::move(mesh));
  Texture texture;  // left red, right green
  texture.width = 2;
  texture.height = 1;
  texture.texels = {{255, 0, 0, 255}, {0, 255, 0, 255}};
  whole.textures.push_back(texture);
  whole.materials[0].base_colour_texture = 0;
  whole.materials[0].emission = glm::vec3(1);
  whole.materials[0].emission_texture = 0;
  const std::optional<Scene> coarse = cluster_vertices(whole, 1'000);
  ASSERT_TRUE(coarse);
  EXPECT_TRUE(coarse->textures.empty());
  EXPECT_FALSE(coarse->materials[0].textured());
  EXPECT_EQ(coarse->materials[0].emission, glm::vec3(0));
  const Mesh& some = coarse->meshes[0];
  ASSERT_EQ(some.colours.size(), some.positions.size());
  for (std::size_t v = 0; v < some.positions.size(); ++v) {
    const float x = some.positions[v].x;
    if (x > 0.01F && x < 0.49F) {
      EXPECT_EQ(some.colours[v], glm::vec4(1, 0, 0, 1));
    }
    if (x > 0.51F && x < 0.99F) {
      EXPECT_EQ(some.colours[v], glm::vec4(0, 1, 0, 1));
    }
  }
}

TEST(ClusterVertices, OfPointsEverySoManyAreLeft) {
  Mesh mesh;
  mesh.shape.kind = Shape::Kind::point;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    mesh.positions.emplace_back(i, 0, 0);
    mesh.triangles.emplace_back(i, i, i);
  }
  const std::optional<Scene> coarse = cluster_vertices(scene_of(mesh), 100);
  ASSERT_TRUE(coarse);
  EXPECT_LE(splat_count(*coarse), 100U);
  EXPECT_GT(splat_count(*coarse), 80U);
  EXPECT_EQ(coarse->meshes[0].shape, mesh.shape);
  EXPECT_GT(coarse->meshes[0].positions.back().x, 950);
}

TEST(ClusterVertices, OfNothingNothingIsLeft) {
  EXPECT_FALSE(cluster_vertices({}, 100));
  Mesh none;
  none.positions.resize(3);
  none.triangles.emplace_back(0, 1, 2);  // all in one place
  EXPECT_FALSE(cluster_vertices(scene_of(none), 100));
  EXPECT_FALSE(cluster_vertices(scene_of(square(64)), 3)) << "more than that at any width";
  Scene unplaced = scene_of(square(64));
  unplaced.instances.clear();
  EXPECT_FALSE(cluster_vertices(unplaced, 10'000));
}

TEST(ClusterVertices, FarPlacesAreNoWorse) {
  Mesh mesh = square(64);
  for (glm::vec3& p : mesh.positions) p *= 1e17F;
  EXPECT_TRUE(cluster_vertices(scene_of(mesh), 10'000));
  for (glm::vec3& p : mesh.positions) p *= 1e-35F;
  EXPECT_TRUE(cluster_vertices(scene_of(mesh), 10'000));
  mesh.positions[0] = glm::vec3(1e18F);
  const std::optional<Scene> coarse = cluster_vertices(scene_of(mesh), 10'000);
  if (coarse) {
    EXPECT_LE(triangle_count(*coarse), 10'000U);
  }
}

}  // namespace
}  // namespace delray::scenes
