#include "scenes/pick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "scenes/generate.h"

namespace delray::scenes {
namespace {

View view_from(const glm::vec3& eye, int width = 100, int height = 80) {
  Camera camera;
  camera.eye = eye;
  return make_view(camera, width, height);
}

// A square of side 2 in the plane of x and y, of two triangles.
Scene square() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  return scene;
}

TEST(Pick, FindsTheTriangleUnderAPlace) {
  const Scene scene = square();
  const View view = view_from({0, 0, 5});
  const auto hit = pick(scene, view, 55, 50);  // right of the middle and below
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0U);
  EXPECT_NEAR(hit->position.z, 0, 1e-6);
  EXPECT_GT(hit->position.x, 0);
  EXPECT_LT(hit->position.y, 0);
  EXPECT_NEAR(hit->depth, 5, 1e-6);
  EXPECT_EQ(pick(scene, view, 45, 30)->triangle, 1U);
  EXPECT_FALSE(pick(scene, view, 1, 1));
  EXPECT_FALSE(pick(scene, view_from({0, 0, -5}), 1, 1));
  EXPECT_FALSE(pick({}, view, 50, 40));
}

TEST(Pick, FindsTheNearestInstance) {
  Scene scene = square();
  scene.instances.push_back({});
  scene.instances[0].transform[3] = {0, 0, -3};
  scene.instances[1].transform[3] = {0, 0, 1};
  scene.instances[1].transform[0] = {0, 2, 0};  // turned and stretched
  scene.instances[1].transform[1] = {-2, 0, 0};
  const auto hit = pick(scene, view_from({0, 0, 5}), 52, 41);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->instance, 1U);
  EXPECT_NEAR(hit->position.z, 1, 1e-6);
  // Behind the eye is nothing.
  EXPECT_EQ(pick(scene, view_from({0, 0, 0.5F}), 52, 41)->instance, 0U);
}

TEST(Pick, FindsPointsAndSegmentsAsFarAsTheyAreDrawn) {
  Scene scene;
  Mesh points;
  points.shape = {Shape::Kind::point, true, 10};
  points.positions = {{0, 0, 0}, {0, 0, -1}, {1, 0, 0}};
  points.triangles = {{0, 0, 0}, {1, 1, 1}};
  Mesh line = points;
  line.shape = {Shape::Kind::line, true, 1};
  line.positions = {{-1, 1, 0}, {1, 1, 0}};
  line.triangles = {{0, 0, 1}};
  scene.meshes = {points, line};
  scene.instances = {{0, {}}, {1, {}}};
  scene.instances[0].transform = scene.instances[1].transform = glm::mat4x3(1.0F);
  const View view = view_from({0, 0, 5});
  const auto hit = pick(scene, view, 58, 40);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0U);
  EXPECT_FALSE(pick(scene, view, 65, 48));
  const float above = view.half_height - view.scale / 5;
  const auto segment = pick(scene, view, view.half_width + view.scale / 10, above + 2);
  ASSERT_TRUE(segment);
  EXPECT_EQ(segment->instance, 1U);
  EXPECT_NEAR(segment->position.x, 0.5, 0.05);
  EXPECT_FALSE(pick(scene, view, view.half_width, above + 6));
}

// The place that was found is seen where it was looked for, and nothing is in front of it.
TEST(Pick, AgreesWithTheView) {
  constexpr unsigned kSeed = 7;
  const Scene scene = generate("gen:city:2000");
  const View view = view_from({0, 60, 60}, 640, 480);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> x(0, 640), y(0, 480);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const float px = x(random), py = y(random);
    const auto hit = pick(scene, view, px, py);
    if (!hit) continue;
    ++hits;
    const glm::vec3 from = glm::vec3(hit->position) - view.eye;
    const float depth = glm::dot(from, view.forward);
    EXPECT_NEAR(view.half_width + glm::dot(from, view.right) / depth * view.scale, px, 0.01)
        << "seed " << kSeed << ", ray " << i;
    EXPECT_NEAR(view.half_height - glm::dot(from, view.up) / depth * view.scale, py, 0.01);
    const Mesh& mesh = scene.meshes[scene.instances[hit->instance].mesh];
    const glm::mat4x3& placed = scene.instances[hit->instance].transform;
    glm::vec3 sum(0.0F);
    for (int k = 0; k < 3; ++k)
      sum += (placed * glm::vec4(mesh.positions[mesh.triangles[hit->triangle][k]], 1.0F)) *
             hit->weights[k];
    EXPECT_LT(glm::length(sum - glm::vec3(hit->position)), 1e-3 * glm::length(from));
  }
  EXPECT_GT(hits, 10);
}

}  // namespace
}  // namespace delray::scenes
