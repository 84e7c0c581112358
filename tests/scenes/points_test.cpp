#include "scenes/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace delray::scenes {
namespace {

constexpr Shape kSpots{Shape::Kind::point, true, 0.5F};

TEST(Points, AreVerticesWithAllThatBelongsToThem) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> both(-1, 1);
  Mesh mesh;
  for (int i = 0; i < 5000; ++i) {
    mesh.positions.emplace_back(both(random), both(random), both(random));
    mesh.colours.emplace_back(mesh.positions.back(), 1);
  }
  std::multiset<float> before;
  for (const glm::vec3& p : mesh.positions) before.insert(p.x);
  make_points(mesh, kSpots);
  EXPECT_EQ(mesh.shape, kSpots);
  ASSERT_EQ(mesh.triangles.size(), 5000U);
  std::multiset<float> after;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(mesh.triangles[i], glm::uvec3(i));
    EXPECT_EQ(glm::vec3(mesh.colours[i]), mesh.positions[i]);
    after.insert(mesh.positions[i].x);
  }
  EXPECT_EQ(before, after);
  Scene scene;
  scene.meshes.push_back(mesh);
  scene.instances = {{0}, {0}};
  EXPECT_EQ(splat_count(scene), 10000U);
  EXPECT_EQ(triangle_count(scene), 0U);
  EXPECT_EQ(first_primitives(scene).back(), 10000U);
}

TEST(Points, SpacingIsThatOfTheLattice) {
  for (const float step : {1e-3F, 1.0F, 250.0F}) {
    Mesh lattice, tilted;
    for (int j = 0; j < 120; ++j) {
      for (int i = 0; i < 90; ++i) {
        const glm::vec3 p(static_cast<float>(i) * step, static_cast<float>(j) * step, 0);
        lattice.positions.push_back(p);
        tilted.positions.emplace_back(p.x * 0.6F, p.y, p.x * 0.8F);
      }
    }
    for (Mesh* const mesh : {&lattice, &tilted}) {
      make_points(*mesh, kSpots);
      EXPECT_NEAR(point_spacing(*mesh) / step, 1, 0.25);
    }
  }
}

TEST(Points, SpacingOfNoneOneAndEqualOnesIsZero) {
  for (const std::size_t n : {0U, 1U, 3U, 5000U}) {
    Mesh mesh;
    mesh.positions.assign(n, {1, 2, 3});
    make_points(mesh, kSpots);
    EXPECT_EQ(point_spacing(mesh), 0) << n;
  }
  Mesh two;
  two.positions = {{0, 0, 0}, {2, 0, 0}};
  make_points(two, kSpots);
  EXPECT_GT(point_spacing(two), 1);
}

TEST(Points, RadiiOfPixelsAreThatWideWhereTheCameraLooks) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{0, 0, 0}};
  make_points(scene.meshes[0], {Shape::Kind::sphere, true, 10});
  glm::mat4x3 twice(1.0F);
  twice[0].x = twice[1].y = twice[2].z = 2;
  scene.instances = {{0, twice}};
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.vertical_fov = 90;
  set_radii_in_units(scene, camera, 100);
  EXPECT_FALSE(scene.meshes[0].shape.in_pixels);
  EXPECT_NEAR(scene.meshes[0].shape.radius, 0.5, 1e-5);  // the frame is 10 units high there
}

}  // namespace
}  // namespace delray::scenes
