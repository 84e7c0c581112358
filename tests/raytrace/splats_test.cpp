// Points and segments in the ray tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "comm/threads.h"
#include "parallel/arena.h"
#include "raytrace/distribution.h"
#include "raytrace/render.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

using Kind = scenes::Shape::Kind;

scenes::Mesh splats(Kind kind, float radius, const std::vector<glm::vec3>& at) {
  scenes::Mesh mesh;
  mesh.shape = {kind, false, radius};
  mesh.positions = at;
  const std::uint32_t step = kind == Kind::line ? 2 : 1;
  for (std::uint32_t i = 0; i + step <= at.size(); i += step)
    mesh.triangles.emplace_back(i, i + step - 1, i + step - 1);
  return mesh;
}

scenes::Camera camera() {
  scenes::Camera camera;
  camera.eye = {0.3F, 0.5F, 4};
  return camera;
}

double mean_difference(const Result& a, const Result& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    const image::RgbaF &p = a.image.colour[i], &q = b.image.colour[i];
    sum += std::abs(p.r - q.r) + std::abs(p.g - q.g) + std::abs(p.b - q.b);
  }
  return sum / static_cast<double>(a.image.pixels());
}

scenes::Scene on_a_floor(scenes::Mesh mesh) {
  scenes::Scene scene;
  add(scene, quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}));
  add(scene, std::move(mesh)).base_colour = {0.7F, 0.3F, 0.2F, 1};
  scenes::complete(scene, camera());
  return scene;
}

// With shadows, reflections and bounces of light.
TEST(RaySplats, SpheresLookAsSpheresOfTrianglesDo) {
  scenes::Mesh ball = sphere(96);
  for (glm::vec3& p : ball.positions) p = p * 0.8F + glm::vec3(0, -0.1F, 0);
  const scenes::Scene triangles = on_a_floor(ball);
  const scenes::Scene points = on_a_floor(splats(Kind::sphere, 0.8F, {{0, -0.1F, 0}}));
  for (const char* integrator : {"whitted", "direct", "path", "ao"}) {
    RenderOptions options = small(64, 64);
    options.integrator = integrator;
    options.samples = 4;
    EXPECT_LT(mean_difference(render_alone(points, camera(), options),
                              render_alone(triangles, camera(), options)),
              0.01)
        << integrator;
  }
}

TEST(RaySplats, SegmentsLookAsCylindersWithRoundEndsDo) {
  // A long one, of which only the cylinder is seen, beside one of triangles.
  constexpr int kSides = 256;
  const glm::vec3 a(-4, -0.2F, -0.5F), b(4, 0.3F, 0.5F);
  const glm::vec3 axis = glm::normalize(b - a);
  const glm::vec3 u = glm::normalize(glm::cross(axis, glm::vec3(0, 1, 0))), v = glm::cross(axis, u);
  scenes::Mesh tube;
  for (int i = 0; i < kSides; ++i) {
    const double turn = 2 * M_PI * i / kSides;
    const glm::vec3 n =
        u * static_cast<float>(std::cos(turn)) + v * static_cast<float>(std::sin(turn));
    for (const glm::vec3& end : {a, b}) {
      tube.positions.push_back(end + n * 0.4F);
      tube.normals.push_back(n);
    }
    const auto first = static_cast<std::uint32_t>(2 * i), next = (first + 2) % (2 * kSides);
    tube.triangles.emplace_back(first, first + 1, next);
    tube.triangles.emplace_back(next, first + 1, next + 1);
  }
  RenderOptions options = small(64, 64);
  options.samples = 4;
  EXPECT_LT(
      mean_difference(render_alone(on_a_floor(splats(Kind::line, 0.4F, {a, b})), camera(), options),
                      render_alone(on_a_floor(tube), camera(), options)),
      0.015);
}

TEST(RaySplats, DiscsFaceTheirNormalsOrTheViewer) {
  scenes::Scene scene;
  scenes::Mesh mesh = splats(Kind::disc, 0.5F, {{0, 0, 0}});
  add(scene, mesh).unlit = true;
  RenderOptions options = small(100, 100);
  const auto covered = [&] {
    const Result result = render_alone(scene, camera(), options);
    double count = 0;
    for (std::size_t i = 0; i < result.image.pixels(); ++i)
      count += result.image.depth[i] < image::kEmptyDepth ? 1 : 0;
    return count;
  };
  options.trace.background = TraceOptions::Background::transparent;
  const double facing = covered();
  EXPECT_GT(facing, 500);
  // Turned away by 60 degrees it looks half as wide.
  const glm::vec3 to_eye = glm::normalize(camera().eye);
  const glm::vec3 aside = glm::normalize(glm::cross(to_eye, glm::vec3(0, 1, 0)));
  scene.meshes[0].normals = {to_eye * 0.5F + aside * std::sqrt(0.75F)};
  EXPECT_NEAR(covered() / facing, 0.5, 0.03);
}

TEST(RaySplats, HaveOnePictureHoweverTheSceneIsSharedOut) {
  const parallel::AllowThreads allowed(6);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> both(-1, 1);
  std::vector<glm::vec3> at;
  at.reserve(400);
  for (int i = 0; i < 400; ++i) at.emplace_back(both(random), both(random), both(random));
  scenes::Scene scene = on_a_floor(splats(Kind::sphere, 0.05F, at));
  add(scene, splats(Kind::line, 0.02F, at), placed(0.7F, {0.2F, 0, 0.1F}));
  add(scene, splats(Kind::disc, 0.06F, at), placed(0.6F, {0, 0.3F, 0.1F})).unlit = true;
  scene.instances.push_back({1, placed(0.3F, {-0.7F, 0.3F, 1.2F})});
  for (int i = 0; i < 400; ++i)
    scene.meshes[3].normals.push_back(glm::normalize(glm::vec3(both(random), both(random), 1)));
  scene.cameras.push_back(camera());
  RenderOptions options = small(80, 60);
  options.samples = 2;
  for (const char* integrator : {"whitted", "path"}) {
    options.integrator = integrator;
    const Result whole = render_alone(scene, camera(), options);
    for (const Distribution& distribution : distributions()) {
      if (distribution.replicated) continue;
      comm::run_threads(3, 2, [&](comm::Communicator& communicator) {
        ShareOptions share;
        share.most_triangles = 64;
        SharedScene mine =
            SharedScene::make(communicator, scene, share_options(distribution, share));
        Renderer renderer(mine, distribution);
        const Result result = renderer.render(communicator, camera(), options);
        if (communicator.rank() != 0) return;
        std::size_t different = 0;
        for (std::size_t i = 0; i < whole.image.pixels(); ++i) {
          const image::RgbaF &a = whole.image.colour[i], &c = result.image.colour[i];
          different += a.r != c.r || a.g != c.g || a.b != c.b || a.a != c.a ||
                       whole.image.depth[i] != result.image.depth[i];
        }
        EXPECT_EQ(different, 0U) << distribution.name << ' ' << integrator;
      });
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
