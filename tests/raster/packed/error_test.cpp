// Pictures with a bound of error beside exact ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "comm/threads.h"
#include "packs/build/surface_error.h"
#include "packs/pack_writer.h"
#include "raster/render.h"
#include "scenes/generate.h"
#include "scenes/points.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/support/temporary_folder.h"

namespace delray::raster {
namespace {

Result of_pack(const packs::PackReader& pack, const scenes::Camera& camera,
               const RenderOptions& options, int ranks = 1, int threads = 1) {
  Result result;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Renderer renderer(pack, pack.scene(), {std::uint64_t{1} << 28});
    Result mine = renderer.render(communicator, camera, options);
    if (communicator.rank() == 0) result = std::move(mine);
  });
  return result;
}

std::size_t pixel_index(const image::Image8& picture, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
         static_cast<std::size_t>(x);
}

// Pixels that are not, within a pixel, at a depth that the other picture has so many pixels around.
std::size_t displaced(const image::Image8& a, const image::Image8& b, const scenes::View& view,
                      int around) {
  std::size_t count = 0;
  for (int y = around; y + around < a.height; ++y) {
    for (int x = around; x + around < a.width; ++x) {
      const float depth = a.depth[pixel_index(a, x, y)];
      float low = image::kEmptyDepth, high = 0;
      for (int j = y - around; j <= y + around; ++j) {
        for (int i = x - around; i <= x + around; ++i) {
          const float other = b.depth[pixel_index(b, i, j)];
          low = std::min(low, other);
          high = std::max(high, other);
        }
      }
      if (depth == image::kEmptyDepth) {
        count += high == image::kEmptyDepth ? 0 : 1;
        continue;
      }
      const float reach = depth / view.scale;
      count += low - reach <= depth && depth <= high + reach ? 0 : 1;
    }
  }
  return count;
}

// Of a point from the segment between two others.
float distance_to_segment(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 way = b - a;
  const float length = glm::dot(way, way);
  const float t = length > 0 ? std::clamp(glm::dot(p - a, way) / length, 0.0F, 1.0F) : 0.0F;
  return glm::distance(p, a + way * t);
}

float distance_to_triangle(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                           const glm::vec3& c) {
  const glm::vec3 normal = glm::cross(b - a, c - a);
  const bool above = glm::dot(glm::cross(b - a, p - a), normal) >= 0 &&
                     glm::dot(glm::cross(c - b, p - b), normal) >= 0 &&
                     glm::dot(glm::cross(a - c, p - c), normal) >= 0;
  if (above && glm::length(normal) > 0)
    return std::abs(glm::dot(p - a, normal)) / glm::length(normal);
  return std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// How far what a picture shows is from a mesh at most, in pixels.
float farthest_in_pixels(const image::Image8& picture, const scenes::View& view,
                         const scenes::Mesh& mesh) {
  scenes::Mesh surface, places;  // without attributes; of triangles that are points
  surface.positions = mesh.positions;
  surface.triangles = mesh.triangles;
  std::vector<float> pixel;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float depth = picture.depth[pixel_index(picture, x, y)];
      if (depth == image::kEmptyDepth) continue;
      const glm::vec3 ray = view.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      places.triangles.emplace_back(static_cast<std::uint32_t>(places.positions.size()));
      places.positions.push_back(view.eye + ray * depth);
      pixel.push_back(depth / view.scale);
    }
  }
  const std::vector<std::uint32_t> nearest =
      packs::internal::surface_errors({places}, surface, 0).nearest;
  float farthest = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[nearest[i]];
    const float distance = distance_to_triangle(places.positions[i], mesh.positions[t.x],
                                                mesh.positions[t.y], mesh.positions[t.z]);
    farthest = std::max(farthest, distance / pixel[i]);
  }
  return farthest;
}

TEST(PackedError, MovesNothingByMoreThanAPixel) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:terrain:40000");
  packs::write_pack(folder / "a.pack", scene);
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 100;
  options.height = 75;
  for (int turn = 0; turn < 3; ++turn) {
    scenes::Camera camera = scene.cameras.front();
    camera.eye = glm::vec3(0.1F + static_cast<float>(turn), 0.9F, 1.7F - static_cast<float>(turn));
    const scenes::View view = scenes::make_view(camera, options.width, options.height);
    options.error = 0;
    const Result exact = of_pack(pack, camera, options);
    options.error = 1;
    const Result coarse = of_pack(pack, camera, options);
    EXPECT_LT(coarse.statistics.triangles_in, exact.statistics.triangles_in * 3 / 4);
    EXPECT_GT(coarse.statistics.pack->levels[1] + coarse.statistics.pack->levels[2], 0U);
    const auto& a = std::get<image::Image8>(exact.picture);
    const auto& b = std::get<image::Image8>(coarse.picture);
    EXPECT_LE(farthest_in_pixels(a, view, scene.meshes[0]), 0.01F) << turn;
    EXPECT_LE(farthest_in_pixels(b, view, scene.meshes[0]), 1) << turn;
    // What is a pixel away at most may lie between pixels that are one and two away.
    for (const auto& [of, beside] : {std::pair(&a, &b), std::pair(&b, &a)}) {
      EXPECT_LE(displaced(*of, *beside, view, 1), 3U) << turn;
      EXPECT_EQ(displaced(*of, *beside, view, 2), 0U) << turn;
    }
  }
}

TEST(PackedError, GivesOnePictureHoweverItIsSharedOut) {
  const tests::TemporaryFolder folder;
  scenes::Scene scene = scenes::generate("gen:terrain:10000");
  scenes::Instance second = scene.instances[0];  // through the first
  second.transform[0].x = -1.3F;
  second.transform[3] = {0.2F, 0.05F, 0.1F};
  scene.instances.push_back(second);
  packs::write_pack(folder / "a.pack", scene);
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 80;
  options.height = 60;
  options.error = 2;
  const Result expected = of_pack(pack, scene.cameras.front(), options);
  EXPECT_GT(expected.statistics.pack->levels[1], 0U);
  for (const char* strategy : {"sort-last", "sort-first"}) {
    options.strategy = strategy;
    for (const int ranks : {1, 2, 3, 5}) {
      const Result found = of_pack(pack, scene.cameras.front(), options, ranks, 1 + ranks % 3);
      EXPECT_TRUE(same_bytes(found.picture, expected.picture)) << strategy << " " << ranks;
    }
  }
}

TEST(PackedError, IsTheSameInAWindow) {
  const tests::TemporaryFolder folder;
  const scenes::Scene scene = scenes::generate("gen:terrain:10000");
  packs::write_pack(folder / "a.pack", scene);
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 90;
  options.height = 70;
  options.error = 1.5;
  const Result whole = of_pack(pack, scene.cameras.front(), options);
  const auto& all = std::get<image::Image8>(whole.picture);
  for (const geometry::Rect window :
       {geometry::Rect{0, 0, 40, 70}, {50, 10, 90, 61}, {33, 20, 50, 45}}) {
    options.window = window;
    const Result part = of_pack(pack, scene.cameras.front(), options, 2);
    const auto& found = std::get<image::Image8>(part.picture);
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const auto at = static_cast<std::size_t>(y * all.width + x);
        const auto in = static_cast<std::size_t>((y - window.y0) * found.width + x - window.x0);
        ASSERT_EQ(found.colour.span()[in], all.colour.span()[at]) << x << " " << y;
      }
    }
  }
}

scenes::Scene scene_of_points(std::vector<glm::vec3> places, const scenes::Shape& shape) {
  scenes::Scene scene;
  scene.meshes.emplace_back().positions = std::move(places);
  scene.instances.push_back({});
  scene.materials.emplace_back();
  scenes::make_points(scene.meshes[0], shape);
  return scene;
}
scenes::Camera camera_above_points() {
  scenes::Camera camera;
  camera.eye = {0.2F, 1.5F, 1.7F};
  return camera;
}

// What is left out of the first level was at the same places, far from each other.
TEST(PackedError, OfPointsThatStandForNoOthersIsNone) {
  const tests::TemporaryFolder folder;
  std::mt19937 random(20261128);
  std::uniform_real_distribution<float> both(-1, 1);
  std::vector<glm::vec3> places;
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 place(both(random), 0, both(random));
    places.insert(places.end(), 60, place);
  }
  packs::write_pack(folder / "a.pack",
                    scene_of_points(places, {scenes::Shape::Kind::point, true, 2.0F}));
  const packs::PackReader pack(folder / "a.pack");
  RenderOptions options;
  options.width = 100;
  options.height = 75;
  const scenes::Camera camera = camera_above_points();
  const Result exact = of_pack(pack, camera, options);
  options.error = 0.5;
  const Result coarse = of_pack(pack, camera, options);
  EXPECT_EQ(coarse.statistics.pack->levels[0], 0U);
  EXPECT_TRUE(same_bytes(coarse.picture, exact.picture));
}

TEST(PackedError, OfPointsLeavesNoGaps) {
  const tests::TemporaryFolder folder;
  std::mt19937 random(20261129);
  std::uniform_real_distribution<float> both(-1, 1);
  constexpr int kPoints = 20000;
  std::vector<glm::vec3> places;
  places.reserve(kPoints);
  for (int i = 0; i < kPoints; ++i) places.emplace_back(both(random), 0, both(random));
  for (const bool in_pixels : {false, true}) {
    packs::write_pack(folder / "a.pack",
                      scene_of_points(places, {in_pixels ? scenes::Shape::Kind::point
                                                         : scenes::Shape::Kind::sphere,
                                               in_pixels, in_pixels ? 1.0F : 0.01F}));
    const packs::PackReader pack(folder / "a.pack");
    RenderOptions options;
    options.width = 100;
    options.height = 75;
    const scenes::Camera camera = camera_above_points();
    const Result exact = of_pack(pack, camera, options);
    options.error = 2;
    const Result coarse = of_pack(pack, camera, options, 2);
    EXPECT_EQ(coarse.statistics.pack->levels[0], 0U);  // all that is there is coarser
    const auto& a = std::get<image::Image8>(exact.picture);
    const auto& b = std::get<image::Image8>(coarse.picture);
    std::size_t covered = 0, gaps = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
      if (a.depth[i] == image::kEmptyDepth) continue;
      ++covered;
      gaps += b.depth[i] == image::kEmptyDepth ? 1 : 0;
    }
    EXPECT_GT(covered, 1000U);
    EXPECT_EQ(gaps, 0U) << in_pixels;
  }
}

}  // namespace
}  // namespace delray::raster
