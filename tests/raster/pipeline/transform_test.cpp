#include "raster/pipeline/transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/raster/coverage.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

// Of all positions, a cluster's worth at a time.
std::vector<ScreenVertex> transformed(const ToView& map, const Screen& screen,
                                      std::span<const glm::vec3> positions) {
  std::vector<ScreenVertex> result;
  ScreenVertices vertices;
  for (std::uint32_t first = 0; first < positions.size(); first += kClusterVertices) {
    std::vector<std::uint32_t> which(
        std::min<std::size_t>(kClusterVertices, positions.size() - first));
    std::iota(which.begin(), which.end(), first);
    transform(map, screen, positions, which, vertices);
    for (std::size_t i = 0; i < which.size(); ++i) result.push_back(vertices[i]);
  }
  return result;
}

TEST(Transform, SnapsWhereTheCameraSays) {
  scenes::Camera camera;
  camera.eye = {3, 2, 5};
  camera.at = {0.5F, 0, 0};
  const scenes::View view = scenes::make_view(camera, 641, 480);
  const Screen screen = make_screen(view);
  const glm::mat4x3 place({0.5F, 0, 0}, {0, 2, 0}, {0, 0, 1}, {0.1F, 0.2F, 0.3F});
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  std::vector<glm::vec3> positions(777);
  for (glm::vec3& p : positions) p = {coordinate(random), coordinate(random), coordinate(random)};
  const std::vector<ScreenVertex> vertices = transformed(to_view(view, place), screen, positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::dvec3 world = glm::dmat4x3(place) * glm::dvec4(positions[i], 1);
    const glm::dvec3 way = world - glm::dvec3(view.eye);
    const double z = glm::dot(way, glm::dvec3(view.forward));
    const double x = view.half_width + glm::dot(way, glm::dvec3(view.right)) / z * view.scale;
    const double y = view.half_height - glm::dot(way, glm::dvec3(view.up)) / z * view.scale;
    ASSERT_NE(vertices[i].x, kOutside);
    EXPECT_NEAR(vertices[i].x / 256.0 + screen.centre_x, x, 0.6 / 256);
    EXPECT_NEAR(vertices[i].y / 256.0 + screen.centre_y, y, 0.6 / 256);
    EXPECT_NEAR(vertices[i].depth, -view.near / z, 1e-6 * view.near / z);
    EXPECT_NEAR(distance_of(vertices[i].depth, view), z, 1e-5 * z);
  }
}

TEST(Transform, IsTheSameOnEveryTargetForEveryCount) {
  const Screen screen = make_screen(plain_view(640, 480));
  const ToView map = to_view(screen.view, glm::mat4x3(1.0F));
  std::mt19937 random(2);
  std::uniform_real_distribution<float> coordinate(-10, 10);
  for (std::size_t n = 0; n < 40; ++n) {
    std::vector<glm::vec3> positions(n);
    for (glm::vec3& p : positions) p = {coordinate(random), coordinate(random), coordinate(random)};
    std::vector<ScreenVertex> first;
    tests::for_each_target([&] {
      const std::vector<ScreenVertex> vertices = transformed(map, screen, positions);
      if (first.empty()) first = vertices;
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(vertices[i].x, first[i].x);
        if (vertices[i].x == kOutside) continue;
        ASSERT_EQ(vertices[i].y, first[i].y);
        ASSERT_EQ(vertices[i].depth, first[i].depth);
      }
    });
  }
}

TEST(Transform, BoundsWhatIsInside) {
  const Screen screen = make_screen(plain_view(640, 480));
  const ToView map = to_view(screen.view, glm::mat4x3(1.0F));
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  for (const std::size_t n : {1, 5, 16, 250, 256}) {
    std::vector<glm::vec3> positions(n);
    for (glm::vec3& p : positions) p = {coordinate(random), coordinate(random), -2};
    std::vector<std::uint32_t> which(n);
    std::iota(which.rbegin(), which.rend(), 0U);
    tests::for_each_target([&] {
      ScreenVertices vertices;
      transform(map, screen, positions, which, vertices);
      EXPECT_FALSE(vertices.any_outside);
      EXPECT_EQ(vertices.low_x, *std::min_element(vertices.x, vertices.x + n));
      EXPECT_EQ(vertices.high_x, *std::max_element(vertices.x, vertices.x + n));
      EXPECT_EQ(vertices.low_y, *std::min_element(vertices.y, vertices.y + n));
      EXPECT_EQ(vertices.high_y, *std::max_element(vertices.y, vertices.y + n));
    });
  }
}

TEST(Transform, MarksWhatCannotBeProjected) {
  const Screen screen = make_screen(plain_view(640, 480));
  const float infinity = std::numeric_limits<float>::infinity();
  const glm::vec3 positions[] = {{0, 0, 1},
                                 {0, 0, 0},
                                 {0, 0, -0.009F},
                                 {1e6F, 0, -1},
                                 {0, -1e6F, -1},
                                 {infinity, 0, -1},
                                 {0, std::nanf(""), -1},
                                 {0, 0, -infinity},
                                 {0, 0, std::nanf("")},
                                 {0, 0, -1},
                                 {0, 0, -0.01F}};
  tests::for_each_target([&] {
    const std::vector<ScreenVertex> vertices =
        transformed(to_view(screen.view, glm::mat4x3(1.0F)), screen, positions);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(vertices[i].x, kOutside) << i;
    EXPECT_EQ(vertices[9].x, 0);
    EXPECT_EQ(vertices[9].y, 0);
    EXPECT_EQ(vertices[10].depth, -1.0F);
  });
}

}  // namespace
}  // namespace delray::raster
