#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "comm/threads.h"
#include "raster/combinations.h"
#include "raster/pipeline/splat.h"
#include "raster/render.h"
#include "tests/raster/allow_threads.h"
#include "tests/raster/kinds_of_picture.h"
#include "tests/raster/splat_scene.h"
#include "tests/support/targets.h"

namespace delray::raster {
namespace {

using Kind = scenes::Shape::Kind;

Picture picture_of(const scenes::Scene& scene, const scenes::Camera& camera,
                   const RenderOptions& options, int ranks = 1, int threads = 1) {
  Picture picture;
  comm::run_threads(ranks, threads, [&](comm::Communicator& communicator) {
    Picture mine = render(communicator, scene, camera, options).picture;
    if (communicator.rank() == 0) picture = std::move(mine);
  });
  return picture;
}

RenderOptions small_picture(int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.block = 16;
  return options;
}

std::size_t covered(const Picture& picture) {
  std::size_t count = 0;
  std::visit(
      [&](const auto& image) {
        for (std::size_t i = 0; i < image.pixels(); ++i)
          count += image.depth[i] < image::kEmptyDepth;
      },
      picture);
  return count;
}

// Every combination of strategies once, with other ranks, threads, samples and lighting each time.
TEST(Splats, HaveOnePictureHoweverTheWorkIsShared) {
  int turn = 0;
  for (const bool with_triangles : {true, false}) {
    for (const Lighting lighting : {Lighting::phong, Lighting::gouraud}) {
      for (const int samples : {1, 2}) {
        const unsigned seed = 100 + static_cast<unsigned>(turn);
        const scenes::Scene scene = splat_scene(seed, with_triangles, 60);
        RenderOptions base = small_picture(83, 71);
        base.lighting = lighting;
        base.supersampling = samples;
        const Picture expected = picture_of(scene, random_scene_camera(), base);
        EXPECT_GT(covered(expected), 1000U);
        int number = 0;
        for (const RenderOptions& options : combinations(base)) {
          if ((++number + turn) % 11 != 0) continue;
          const int ranks = 2 + number % 4, threads = 1 + number % 3;
          EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options, ranks, threads),
                                 expected))
              << name_of(options) << " ranks " << ranks << " seed " << seed;
        }
        ++turn;
      }
    }
  }
}

TEST(Splats, ShadeAtOnceAndOnEveryInstructionSetAlike) {
  for (const bool with_triangles : {true, false}) {
    const scenes::Scene scene = splat_scene(7, with_triangles);
    RenderOptions options = small_picture(150, 131);
    options.float_pixels = true;
    const Picture expected = picture_of(scene, random_scene_camera(), options);
    tests::for_each_target([&] {
      EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options), expected));
    });
    options.shade = Shade::immediate;
    EXPECT_TRUE(same_bytes(picture_of(scene, random_scene_camera(), options, 1, 3), expected));
  }
}

// One mesh of unlit points, white or of the colours given.
scenes::Scene plain_points(const std::vector<glm::vec3>& at, const scenes::Shape& shape,
                           const std::vector<glm::vec4>& colours = {}) {
  scenes::Scene scene;
  scene.materials.resize(1);
  scene.materials[0].unlit = true;
  scene.materials[0].base_colour = glm::vec4(1);
  scenes::Mesh mesh;
  mesh.shape = shape;
  mesh.colours = colours;
  for (const glm::vec3& p : at) add_point(mesh, p);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({});
  return scene;
}

scenes::Camera camera_at_origin(float near = 0.01F) {
  scenes::Camera camera;
  camera.eye = {0, 0, 0};
  camera.at = {0, 0, -1};
  camera.vertical_fov = 90;
  camera.near = near;
  return camera;
}

double distance_to(double x, double y, const glm::dvec2& p) { return std::hypot(x - p.x, y - p.y); }

// Where a point of view coordinates is seen in a frame of the camera at the origin.
glm::dvec2 seen_at(const glm::dvec3& p, int width, int height) {
  return {0.5 * width + p.x / -p.z * 0.5 * height, 0.5 * height - p.y / -p.z * 0.5 * height};
}

// In doubles, at all pixels whose centres are not within the rounding of positions of the border.
TEST(Splats, SpotsCoverTheirPixelAndThoseWhoseCentresAreWithinTheirRadius) {
  constexpr int kWidth = 97, kHeight = 80;
  constexpr double kRounding = 0.01;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> both(-1, 1);
    const float radius = seed == 1 ? 0.0F : seed == 2 ? 0.5F : std::exp2(0.8F * float(seed) - 2);
    const glm::vec3 p(1.3F * both(random), 1.1F * both(random), -1.0F);
    const Picture picture = picture_of(plain_points({p}, {Kind::point, true, radius}),
                                       camera_at_origin(), small_picture(kWidth, kHeight));
    const auto& image = std::get<image::Image8>(picture);
    const glm::dvec2 centre = seen_at(p, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double apart = distance_to(x + 0.5, y + 0.5, centre);
        const bool own = x == std::floor(centre.x) && y == std::floor(centre.y);
        if (std::abs(apart - radius) < kRounding ||
            std::abs(centre.x - std::round(centre.x)) < kRounding ||
            std::abs(centre.y - std::round(centre.y)) < kRounding)
          continue;
        EXPECT_EQ(image.colour[y * kWidth + x].a == 255, own || apart < radius)
            << x << ' ' << y << " seed " << seed;
      }
    }
  }
}

TEST(Splats, RaysMeetSpheresDiscsAndSegmentsWhereTheyAre) {
  constexpr int kWidth = 90, kHeight = 80;
  std::size_t seen = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> both(-1, 1);
    const Kind kind = seed % 3 == 0 ? Kind::sphere : seed % 3 == 1 ? Kind::disc : Kind::line;
    const float radius = 0.02F + 0.3F * std::abs(both(random));
    const glm::vec3 a(both(random), both(random), -2.5F + both(random));
    const glm::vec3 b =
        kind == Kind::line ? a + glm::vec3(both(random), both(random), both(random)) : a;
    scenes::Scene scene = plain_points({a}, {kind, false, radius});
    scene.meshes[0].positions.push_back(b);
    scene.meshes[0].triangles[0] = {0, 1, 1};
    const Picture picture = picture_of(scene, camera_at_origin(), small_picture(kWidth, kHeight));
    const auto& image = std::get<image::Image8>(picture);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::dvec3 ray((x + 0.5 - 0.5 * kWidth) / (0.5 * kHeight),
                             (0.5 * kHeight - y - 0.5) / (0.5 * kHeight), -1);
        // The least distance of the ray from the segment, by search.
        double least = 1e9, at = 0;
        for (int k = 0; k <= 1000; ++k) {
          const glm::dvec3 q = glm::mix(glm::dvec3(a), glm::dvec3(b), k / 1000.0);
          const double t = glm::dot(q, ray) / glm::dot(ray, ray);
          const double apart = glm::length(q - ray * t);
          if (apart < least) least = apart, at = t;
        }
        if (std::abs(least - radius) < 2e-3) continue;
        const bool covered = image.colour[y * kWidth + x].a == 255;
        EXPECT_EQ(covered, least < radius) << x << ' ' << y << " seed " << seed;
        if (!covered) continue;
        ++seen;
        const double depth = image.depth[y * kWidth + x];
        // On the surface, nearer than the middle.
        if (kind == Kind::disc) {
          EXPECT_NEAR(depth, at, 1e-4) << seed;
          continue;
        }
        const glm::dvec3 hit = ray * depth;
        double from_axis = 1e9;
        for (int k = 0; k <= 1000; ++k) {
          from_axis = std::min(
              from_axis, glm::length(glm::mix(glm::dvec3(a), glm::dvec3(b), k / 1000.0) - hit));
        }
        EXPECT_NEAR(from_axis, radius, 2e-3) << seed;
        EXPECT_LT(depth, at + 1e-4) << seed;
      }
    }
  }
  EXPECT_GT(seen, 500U);
}

TEST(Splats, TheNearestWinsAndOfEquallyNearOnesTheFirst) {
  const glm::vec4 red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 1);
  const auto middle = [](const scenes::Scene& scene) {
    const Picture picture = picture_of(scene, camera_at_origin(), small_picture(21, 21), 1, 2);
    return std::get<image::Image8>(picture).colour[10 * 21 + 10];
  };
  for (const Kind kind : {Kind::point, Kind::disc, Kind::sphere}) {
    for (const float radius : {1.0F, 30.0F}) {
      const scenes::Shape shape{kind, true, radius};
      EXPECT_EQ(
          middle(plain_points({{0, 0, -3}, {0, 0, -2}, {0, 0, -4}}, shape, {red, green, blue})).g,
          255);
      const std::vector<glm::vec3> same(3, {0, 0, -2});
      EXPECT_EQ(middle(plain_points(same, shape, {blue, red, green})).b, 255);
    }
  }
}

TEST(Splats, OddOnesDoNoHarm) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const RenderOptions options = small_picture(70, 50);
  for (const Kind kind : {Kind::point, Kind::disc, Kind::sphere, Kind::line}) {
    for (const bool in_pixels : {true, false}) {
      const auto covered_by = [&](const std::vector<glm::vec3>& at, float radius) {
        return covered(
            picture_of(plain_points(at, {kind, in_pixels, radius}), camera_at_origin(), options));
      };
      EXPECT_EQ(covered_by({}, 1), 0U);
      EXPECT_EQ(covered_by({{0, 0, 5}}, 0.2F), 0U) << "behind the eye";
      EXPECT_EQ(covered_by({{kNan, 0, -1}, {0, kInfinity, -1}, {1e30F, 0, -1e30F}}, 0),
                0U + (kind == Kind::point));
      EXPECT_EQ(covered_by({{0, 0, -1}}, 0), kind == Kind::point ? 1U : 0U) << "radius 0";
      EXPECT_EQ(covered_by({{0, 0, -1}}, 1e30F), 3500U) << "all around";
      EXPECT_GT(covered_by(std::vector<glm::vec3>(3, {0.02F, 0.02F, -1}), 0.3F), 0U);
    }
    // Before the near plane, but not all of it; spots are where their centres are.
    scenes::Scene scene = plain_points({{0, 0, 0.5F}}, {kind, false, 3});
    EXPECT_EQ(covered(picture_of(scene, camera_at_origin(1), options)),
              kind == Kind::sphere || kind == Kind::line ? 3500U : 0U);
  }
}

// Small spots are set up by vectors, and those of the same picture one by one.
// Radii in samples, and in the world's units, of which some are too large for vectors.
TEST(Splats, AreTheSameByVectorsAndOneByOne) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const bool in_samples = seed <= 6;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> both(-1, 1);
    std::vector<glm::vec3> at;
    std::vector<glm::vec4> colours;
    for (int i = 0; i < 3000; ++i) {
      at.emplace_back(1.5F * both(random), 1.5F * both(random), -1 - both(random));
      colours.emplace_back(both(random), both(random), both(random), 1);
    }
    const float radius = in_samples ? 0.7F * static_cast<float>(seed) - 0.4F
                                    : 0.002F * static_cast<float>((seed - 6) * (seed - 6));
    scenes::Scene scene = plain_points(at, {Kind::point, in_samples, radius}, colours);
    const Picture expected = picture_of(scene, camera_at_origin(), small_picture(201, 140));
    // Points that share vertices, and none in their order.
    scenes::Mesh& mesh = scene.meshes[0];
    for (std::uint32_t i = 0; i < 3000; ++i) {
      mesh.positions.push_back(mesh.positions[i]);
      mesh.colours.push_back(mesh.colours[i]);
      mesh.triangles[i] = glm::uvec3(i % 2 == 0 ? i : 3000 + i);
    }
    EXPECT_TRUE(
        same_bytes(picture_of(scene, camera_at_origin(), small_picture(201, 140)), expected))
        << seed;
    const Screen screen = make_screen(scenes::make_view(camera_at_origin(), 201, 140));
    const Draw draw{&mesh, &scene.instances[0].transform};
    const SplatDraw splats = make_splat_draw(screen, draw);
    std::vector<std::int64_t> keys(std::size_t{201} * 140, kEmptyKey);
    for (std::uint32_t t = 0; t < 3000; ++t) {
      const Splat splat = make_splat(screen, splats, mesh, t, t);
      for (int y = splat.pixels.y0; y < splat.pixels.y1; ++y) {
        for (int x = splat.pixels.x0; x < splat.pixels.x1; ++x) {
          float depth;
          if (!covers(screen, splat, x, y, depth)) continue;
          std::int64_t& key = keys[static_cast<std::size_t>(y) * 201 + static_cast<std::size_t>(x)];
          key = std::min(key, key_of(depth, t));
        }
      }
    }
    const auto& image = std::get<image::Image8>(expected);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const float depth = depth_of(keys[i]);
      EXPECT_EQ(image.depth[i], depth < 0 ? distance_of(depth, screen.view) : depth) << i;
    }
  }
}

TEST(Splats, AWindowHasTheFramesBytes) {
  const scenes::Scene scene = splat_scene(11, true, 200);
  RenderOptions options = small_picture(120, 90);
  const Picture whole_picture = picture_of(scene, random_scene_camera(), options);
  const auto& whole = std::get<image::Image8>(whole_picture);
  options.window = {37, 21, 103, 82};
  const Picture window_picture = picture_of(scene, random_scene_camera(), options, 2, 2);
  const auto& window = std::get<image::Image8>(window_picture);
  ASSERT_EQ(window.width, 66);
  ASSERT_EQ(window.height, 61);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const int i = y * window.width + x, k = (y + 21) * whole.width + x + 37;
      EXPECT_EQ(window.colour[i], whole.colour[k]) << x << ' ' << y;
      EXPECT_EQ(window.depth[i], whole.depth[k]) << x << ' ' << y;
    }
  }
}

// Points without light are shaded by a way of their own.
TEST(Splats, PlainOnesHaveOnePictureToo) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  std::vector<glm::vec3> at;
  std::vector<glm::vec4> colours;
  for (int i = 0; i < 900; ++i) {
    at.emplace_back(both(random), both(random), -1.5F - both(random));
    colours.emplace_back(unit(random), unit(random), unit(random), unit(random));
  }
  for (const Kind kind : {Kind::point, Kind::sphere}) {
    const scenes::Scene scene = plain_points(at, {kind, true, 2.2F}, colours);
    RenderOptions base = small_picture(90, 70);
    base.supersampling = 2;
    const Picture expected = picture_of(scene, camera_at_origin(), base);
    int number = 0;
    for (const RenderOptions& options : combinations(base)) {
      if (++number % 7 != 0) continue;
      EXPECT_TRUE(same_bytes(picture_of(scene, camera_at_origin(), options, 3, 2), expected))
          << name_of(options);
    }
    base.shade = Shade::immediate;
    EXPECT_TRUE(same_bytes(picture_of(scene, camera_at_origin(), base), expected));
  }
}

}  // namespace
}  // namespace delray::raster
