#include "scenes/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::scenes {
namespace {

struct Projected {
  glm::dvec2 pixel;
  double depth;
};

Projected project(const View& view, const glm::dvec3& p) {
  const glm::dvec3 v = p - glm::dvec3(view.eye);
  const double depth = glm::dot(v, glm::dvec3(view.forward));
  return {{view.half_width + glm::dot(v, glm::dvec3(view.right)) / depth * view.scale,
           view.half_height - glm::dot(v, glm::dvec3(view.up)) / depth * view.scale},
          depth};
}

glm::dvec3 corner(const geometry::Box3& box, int i) {
  return {(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
          (i & 4) != 0 ? box.high.z : box.low.z};
}

TEST(Camera, RayThroughTheProjectionOfAPointMeetsThePoint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    const View view =
        make_view({vector() * 5.0F, vector(), vector(), 20 + 50 * std::abs(unit(random)), 0},
                  1 + trial % 700, 1 + trial % 500);
    const glm::dvec3 p = vector() * 10.0F;
    const Projected projected = project(view, p);
    if (projected.depth < 0.5 || glm::length(projected.pixel) > 1e4) continue;
    const glm::vec3 ray =
        view.ray(static_cast<float>(projected.pixel.x), static_cast<float>(projected.pixel.y));
    const glm::dvec3 met = glm::dvec3(view.eye) + glm::dvec3(ray) * projected.depth;
    EXPECT_LT(glm::distance(met, p), 2e-5 * (10 + glm::length(p))) << "trial " << trial;
    EXPECT_NEAR(glm::dot(ray, view.forward), 1, 1e-5);
  }
}

TEST(Camera, OrthographicRaysAreParallelAndMeetWhatIsProjected) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  for (int trial = 0; trial < 300; ++trial) {
    Camera camera;
    camera.eye = vector() * 5.0F;
    camera.at = vector();
    camera.up = vector();
    camera.height = 0.5F + std::abs(unit(random)) * 3;
    camera.aperture = 1;
    const View view = make_view(camera, 1 + trial % 300, 1 + trial % 200);
    EXPECT_FLOAT_EQ(view.scale * camera.height, static_cast<float>(view.height));
    EXPECT_GT(view.far, view.near);
    const glm::vec3 p = vector() * 3.0F, v = p - view.eye;
    const float x = view.half_width + glm::dot(v, view.right) * view.scale;
    const float y = view.half_height - glm::dot(v, view.up) * view.scale;
    const View::Ray ray = view.ray(x, y, {0.5F, 0.5F});
    EXPECT_EQ(ray.direction, view.forward);
    const glm::vec3 met = ray.origin + ray.direction * glm::dot(v, view.forward);
    EXPECT_LT(glm::distance(met, p), 1e-4F) << trial;
    // Its pixel is among those of any box that holds it, in front of the eye or behind.
    const glm::vec3 size = glm::abs(vector()) * 0.1F;
    const geometry::Rect pixels = pixels_of(view, {p - size, p + size});
    const auto column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const bool in_frame = column >= 0 && row >= 0 && column < view.width && row < view.height;
    EXPECT_TRUE(!in_frame || pixels.contains(column, row)) << trial;
  }
}

// Whatever is seen of a box is seen in its pixels, however close to the edge of the frame.
TEST(Camera, PixelsOfABoxHaveAllRaysThatMeetIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1, 1);
  int parts = 0, seen = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    const float far = std::pow(10.0F, 2.0F * unit(random) + 1.0F);
    const float angle = trial % 5 == 0 ? 0.01F : 20 + 50 * std::abs(unit(random));
    const View view =
        make_view({vector() * far, vector(), vector(), angle, 0}, 1 + trial % 700, 1 + trial % 500);
    geometry::Box3 box;
    box.include(vector() * 2.0F);
    box.include(vector() * 2.0F);
    const geometry::Rect pixels = pixels_of(view, box);
    parts += pixels.area() < std::int64_t{view.width} * view.height ? 1 : 0;
    for (int k = 0; k < 40; ++k) {
      const glm::dvec3 weight = (glm::dvec3(vector()) + 1.0) * 0.5;
      const glm::dvec3 p =
          k < 8 ? corner(box, k) : glm::mix(glm::dvec3(box.low), glm::dvec3(box.high), weight);
      const Projected at = project(view, p);
      const glm::dvec2 cell = glm::floor(at.pixel);
      if (!(at.depth > 0) || cell.x < 0 || cell.y < 0 || cell.x >= view.width ||
          cell.y >= view.height)
        continue;
      ++seen;
      EXPECT_TRUE(pixels.contains(static_cast<int>(cell.x), static_cast<int>(cell.y)))
          << "trial " << trial;
    }
  }
  EXPECT_GT(parts, 500);
  EXPECT_GT(seen, 5000);
}

TEST(Camera, PixelsOfABoxAreNoneOrAllWhereThereIsNothingToTell) {
  Camera camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40, 0};
  const geometry::Rect all{0, 0, 64, 48};
  const geometry::Box3 small{glm::vec3(-0.1F), glm::vec3(0.1F)};
  EXPECT_TRUE(pixels_of(make_view(camera, 64, 48), {}).empty());
  EXPECT_LT(pixels_of(make_view(camera, 64, 48), small).area(), 100);
  EXPECT_EQ(pixels_of(make_view(camera, 64, 48), {glm::vec3(-1), glm::vec3(6)}), all);
  camera.aperture = 0.1F;
  EXPECT_EQ(pixels_of(make_view(camera, 64, 48), small), all);
}

TEST(Camera, ViewHasItsAxesAtRightAnglesAndItsFieldOfView) {
  const View view = make_view({{3, 2, 5}, {1, 0, -1}, {0, 1, 0}, 60, 0}, 640, 480);
  EXPECT_NEAR(glm::length(view.right), 1, 1e-6);
  EXPECT_NEAR(glm::dot(view.right, view.up), 0, 1e-6);
  EXPECT_NEAR(glm::dot(view.up, view.forward), 0, 1e-6);
  EXPECT_GT(view.up.y, 0.5F);
  EXPECT_LT(glm::distance(glm::cross(view.right, view.up), -view.forward), 1e-6F);
  // The ray through the middle of the upper edge is half the field of view above the axis.
  const glm::vec3 top = view.ray(320, 0);
  EXPECT_NEAR(glm::dot(top, view.up) / glm::dot(top, view.forward), std::tan(3.14159265 / 6), 1e-6);
  EXPECT_NEAR(view.near, 1e-3F * glm::distance(glm::vec3(3, 2, 5), glm::vec3(1, 0, -1)), 1e-6F);
}

TEST(Camera, RaysThroughTheLensMeetAtTheFocusDistance) {
  Camera camera;
  camera.eye = {3, -1, 2};
  camera.at = {1, 4, -2};
  camera.aperture = 0.5F;
  camera.focus = 7.0F;
  const View view = make_view(camera, 80, 60);
  for (const glm::vec2 pixel : {glm::vec2(40, 30), glm::vec2(3.5F, 51)}) {
    const glm::vec3 focus = view.eye + view.ray(pixel.x, pixel.y) * 7.0F;
    for (const glm::vec2 lens : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(-0.6F, 0.8F)}) {
      const View::Ray ray = view.ray(pixel.x, pixel.y, lens);
      EXPECT_LT(glm::length(ray.origin + ray.direction * 7.0F - focus), 1e-5F);
      EXPECT_NEAR(glm::length(ray.origin - view.eye), 0.25F * glm::length(lens), 1e-6F);
      EXPECT_NEAR(glm::dot(ray.direction, view.forward), 1.0F, 1e-5F);
      EXPECT_NEAR(glm::dot(ray.origin - view.eye, view.forward), 0.0F, 1e-5F);
    }
  }
}

TEST(Camera, FocusesOnWhatItLooksAtAndIsAPinholeUnlessTold) {
  Camera camera;
  camera.eye = {0, 0, 5};
  const View view = make_view(camera, 8, 8);
  EXPECT_EQ(view.focus_distance, 5.0F);
  EXPECT_EQ(view.lens_radius, 0.0F);
  const View::Ray ray = view.ray(2, 3, {0.7F, -0.7F});
  EXPECT_EQ(ray.origin, view.eye);
  EXPECT_EQ(ray.direction, view.ray(2, 3));
  camera.at = camera.eye;
  camera.aperture = -1.0F;
  EXPECT_EQ(make_view(camera, 8, 8).lens_radius, 0.0F);
  EXPECT_GT(make_view(camera, 8, 8).focus_distance, 0.0F);
}

TEST(Camera, DegenerateCamerasGiveSomeView) {
  const Camera cameras[] = {{{1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 40, 0},
                            {{0, 0, 0}, {0, 5, 0}, {0, 1, 0}, 40, 0},
                            {{0, 0, 0}, {0, 0, -5}, {0, 0, 3}, 40, 0},
                            {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 40, 0}};
  for (const Camera& camera : cameras) {
    const View view = make_view(camera, 10, 10);
    EXPECT_NEAR(glm::length(view.right), 1, 1e-6);
    EXPECT_NEAR(glm::length(view.up), 1, 1e-6);
    EXPECT_NEAR(glm::length(view.forward), 1, 1e-6);
    EXPECT_NEAR(glm::dot(view.right, view.forward), 0, 1e-6);
    EXPECT_GT(view.near, 0);
  }
}

}  // namespace
}  // namespace delray::scenes
