// Features of shapes that are known, and what does not change them.
#include "scenes/shape_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scenes/generate.h"

namespace delray::scenes {
namespace {

Scene of_mesh(Mesh mesh) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  return scene;
}

// A sphere of so many rings, as an ellipsoid.
Scene ellipsoid(int rings, const glm::vec3& axes) {
  Mesh mesh;
  const int around = 2 * rings;
  constexpr double kPi = 3.14159265358979;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double a = kPi * i / rings, b = 2 * kPi * j / around;
      mesh.positions.push_back(
          axes * glm::vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const int next = (j + 1) % around;
      mesh.triangles.emplace_back(i * around + j, (i + 1) * around + j, (i + 1) * around + next);
      mesh.triangles.emplace_back(i * around + j, (i + 1) * around + next, i * around + next);
    }
  }
  return of_mesh(std::move(mesh));
}

TEST(ShapeFeatures, OfASphereAreKnown) {
  const auto features = features_of_shape(ellipsoid(100, {1, 1, 1}));
  ASSERT_TRUE(features);
  EXPECT_NEAR((*features)[0], 1, 1e-3);
  EXPECT_NEAR((*features)[1], 1, 1e-3);
  // Distances have mean 4/3 and mean square 2; the density grows as the distance, up to 2.
  EXPECT_NEAR((*features)[2], std::sqrt(2.0 - 16.0 / 9) / (4.0 / 3), 2e-3);
  EXPECT_NEAR((*features)[3], 1, 1e-3);
  EXPECT_NEAR((*features)[4], 0, 1e-3);
  EXPECT_NEAR((*features)[5], -2 * std::sqrt(2.0) / 5, 5e-3);
}

TEST(ShapeFeatures, OfASquareAreKnown) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto features = features_of_shape(of_mesh(std::move(mesh)));
  ASSERT_TRUE(features);
  EXPECT_NEAR((*features)[0], 0.5, 1e-12);
  EXPECT_NEAR((*features)[1], 0, 1e-7);
  EXPECT_NEAR((*features)[3], std::sqrt(1.25) / std::sqrt(5.0 / 12), 1e-12);
}

TEST(ShapeFeatures, DoNotDependOnPlaceTurnAndScaleAndLittleOnTriangles) {
  const Scene model = ellipsoid(60, {3, 2, 1});
  const auto features = features_of_shape(model);
  ASSERT_TRUE(features);
  std::mt19937 random(7);
  const auto number = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  for (int turn = 0; turn < 5; ++turn) {
    Scene moved = model;
    glm::mat4 transform =
        glm::translate(glm::mat4(1), 5.0F * glm::vec3(number(), number(), number()));
    transform =
        glm::rotate(transform, 3 * number(), glm::normalize(glm::vec3(number(), number(), 1.5F)));
    transform = glm::scale(transform, glm::vec3(1.5F + number()));
    moved.instances[0].transform = glm::mat4x3(transform);
    const auto of_moved = features_of_shape(moved);
    ASSERT_TRUE(of_moved);
    for (int k = 0; k < kShapeFeatures; ++k) {
      EXPECT_NEAR((*of_moved)[k], (*features)[k], 1e-4) << shape_features()[k].name;
    }
  }
  const auto of_few = features_of_shape(ellipsoid(15, {3, 2, 1}));
  ASSERT_TRUE(of_few);
  for (int k = 0; k < kShapeFeatures; ++k) {
    EXPECT_NEAR((*of_few)[k], (*features)[k], 0.02) << shape_features()[k].name;
  }
}

TEST(ShapeFeatures, WithoutAreaThereAreNone) {
  EXPECT_FALSE(features_of_shape(Scene{}));
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_FALSE(features_of_shape(of_mesh(std::move(mesh))));
}

}  // namespace
}  // namespace delray::scenes
