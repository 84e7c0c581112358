#include "raytrace/first_hits/first_hits.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "scenes/framing.h"
#include "scenes/generate.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

using Random = std::mt19937;

glm::vec3 in_cube(Random& random, float side) {
  std::uniform_real_distribution<float> both(-side, side);
  const float x = both(random), y = both(random), z = both(random);
  return {x, y, z};
}

void add_triangle(scenes::Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

// Triangles of all sizes around the origin, among them slivers, some in each other, some through
// the camera's plane, flat ones and points, and some that the camera sees from the side.
scenes::Mesh soup(Random& random, const glm::vec3& eye, int count) {
  std::uniform_real_distribution<float> unit(0, 1);
  scenes::Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float size = std::pow(10.0F, -3.0F * unit(random));
    const glm::vec3 a = in_cube(random, 1), b = a + in_cube(random, size);
    const glm::vec3 c = a + in_cube(random, size);
    switch (i % 9) {
      case 0:  // the same place again, the other way round
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a, c, b);
        break;
      case 1:  // in one plane, overlapping
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a, b, a + (c - a) * 0.5F);
        break;
      case 2:  // slivers
        add_triangle(mesh, a, a + (b - a) * 3.0F, a + (b - a) * 1.5F + in_cube(random, 1e-4F));
        break;
      case 3:  // seen from the side
        add_triangle(mesh, a, b, eye + (a - eye) * 0.9F + (b - eye) * 0.1F);
        break;
      case 4:  // through the eye's plane, far beyond
        add_triangle(mesh, a * 8.0F, b * 8.0F, c * 8.0F + eye);
        break;
      case 5:  // flat
        add_triangle(mesh, a, b, (a + b) * 0.5F);
        add_triangle(mesh, a, a, b);
        add_triangle(mesh, a, a, a);
        break;
      case 6:  // hardly apart
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a + in_cube(random, 1e-6F), b, c);
        break;
      default:
        add_triangle(mesh, a, b, c);
    }
  }
  return mesh;
}

glm::mat4x3 some_transform(Random& random) {
  glm::mat4x3 m(0.0F);
  for (int k = 0; k < 3; ++k) m[k] = in_cube(random, 0.7F);
  m[0].x += 0.6F, m[1].y += 0.6F, m[2].z += 0.6F;
  m[3] = in_cube(random, 1);
  return m;
}

// Meshes placed once and several times, opaque, with holes and blended.
scenes::Scene some_scene(unsigned seed, const glm::vec3& eye) {
  Random random(seed);
  scenes::Scene scene;
  add(scene, soup(random, eye, 60)).double_sided = true;
  add(scene, sphere(6), placed(0.6F, in_cube(random, 1)));
  scenes::Material& glass = add(scene, sphere(8), placed(0.4F, in_cube(random, 1)));
  glass.alpha = scenes::Material::Alpha::blend;
  glass.base_colour.w = 0.5F;
  add(scene, soup(random, eye, 20), some_transform(random));
  for (int i = 0; i < 4; ++i) scene.instances.push_back({3, some_transform(random)});
  scene.instances.push_back({1, some_transform(random)});
  if (seed % 2 == 1) {  // through axes and in step with pixels
    add(scene, quad({-2, -1, -1}, {4, 0, 0}, {0, 0, 3}));
    add(scene, quad({-2, -1, -1}, {4, 0, 0}, {0, 2, 0}));
  }
  scene.lights.push_back({});
  scene.environment.zenith = {0.3F, 0.4F, 0.6F};
  return scene;
}

// Pictures by rays and by rasterization; returns how many first hits were rasterized.
std::uint64_t expect_same(const scenes::Scene& scene, const scenes::Camera& camera,
                          RenderOptions options, const std::string& what) {
  const Tracer tracer = make_tracer(scene, options.build);
  Result results[2];
  for (const Primary primary : {Primary::trace, Primary::raster_always}) {
    options.primary = primary;
    comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
      results[primary == Primary::trace ? 0 : 1] = render(communicator, tracer, camera, options);
    });
  }
  const image::ImageF &a = results[0].image, &b = results[1].image;
  EXPECT_EQ(a.pixels(), b.pixels());
  EXPECT_EQ(std::memcmp(a.colour.data(), b.colour.data(), a.pixels() * sizeof(image::RgbaF)), 0)
      << what;
  EXPECT_EQ(std::memcmp(a.depth.data(), b.depth.data(), a.pixels() * sizeof(float)), 0) << what;
  RayCounts traced = results[0].statistics.rays, rasterized = results[1].statistics.rays;
  const std::uint64_t count = rasterized.rasterized;
  EXPECT_EQ(traced.rasterized, 0U);
  EXPECT_LE(count, traced.primary);
  rasterized.rasterized = 0;
  EXPECT_EQ(traced, rasterized) << what;
  return count;
}

scenes::Camera camera_at(const glm::vec3& eye, const glm::vec3& at = {0, 0, 0}) {
  scenes::Camera camera;
  camera.eye = eye;
  camera.at = at;
  return camera;
}

// Whether this machine's Embree has the arithmetic that is known; hits are traced otherwise.
bool is_known() {
  static const bool known = [] {
    const scenes::Scene scene = some_scene(0, {0, 0, 3});
    const Tracer tracer = make_tracer(scene);
    const scenes::View view = scenes::make_view(camera_at({0, 0, 3}), 64, 48);
    FirstHits::Trials trials;
    return FirstHits::make(tracer, {view, {0, 0, 64, 48}, 2.0F}, 1, true, trials).hits != nullptr;
  }();
  return known;
}
// Lest pictures are the same because nothing is rasterized.
void expect_some(std::uint64_t rasterized) {
  if (is_known()) {
    EXPECT_GT(rasterized, 0U);
  }
}

// Lest a change of ours makes the arithmetic another one, and all is traced for ever.
TEST(FirstHits, KnowThePackagedEmbree) {
  const EmbreeDevice device(BuildOptions{});
  if (!device.version().starts_with("3.13") || !device.isa().starts_with("avx512"))
    GTEST_SKIP() << "its arithmetic is that of Embree 3.13 with AVX-512; here is "
                 << device.version() << ", " << device.isa();
  EXPECT_TRUE(is_known());
}

#if defined(__x86_64__)
TEST(FirstHits, AreTracedByAnotherArithmetic) {
  RenderOptions options = small(64, 48);
  options.build.isa = "sse2";
  EXPECT_EQ(expect_same(some_scene(3, {0, 1, 3}), camera_at({0, 1, 3}), options, "sse2"), 0U);
}
#endif

TEST(FirstHits, AreThoseOfRaysInScenesOfAllKinds) {
  constexpr unsigned kScenes = 60;
  std::uint64_t rasterized = 0;
  for (unsigned seed = 0; seed < kScenes; ++seed) {
    Random random(seed + 1000);
    // Outside, and within the scene.
    const glm::vec3 eye = in_cube(random, 1) * (seed % 3 == 0 ? 0.7F : 3.0F);
    const scenes::Scene scene = some_scene(seed, eye);
    RenderOptions options = small(77, 53);
    options.integrator = seed % 4 == 0 ? "whitted" : "identity";
    rasterized += expect_same(scene, camera_at(eye), options, "seed " + std::to_string(seed));
  }
  expect_some(rasterized);
}

TEST(FirstHits, AreThoseOfManySamples) {
  for (const char* integrator : {"direct", "ao", "path"}) {
    for (const int samples : {3, 4}) {
      RenderOptions options = small(45, 38);
      options.integrator = integrator;
      options.samples = samples;
      expect_some(expect_same(some_scene(7, {0, 1, 3}), camera_at({0, 1, 3}), options,
                              std::string(integrator) + " with " + std::to_string(samples)));
    }
  }
}

TEST(FirstHits, AreThoseOfPartsOfPicturesAndTilesOfAnySide) {
  RenderOptions options = small(101, 67);
  options.integrator = "identity";
  const scenes::Scene scene = some_scene(3, {0.2F, 1, 3});
  for (const int tile : {1, 3, 10, 16, 40}) {
    options.tile = tile;
    expect_some(
        expect_same(scene, camera_at({0.2F, 1, 3}), options, "tiles of " + std::to_string(tile)));
  }
  options.part.window = {16, 32, 64, 67};
  expect_same(scene, camera_at({0.2F, 1, 3}), options, "window");
}

TEST(FirstHits, AreThoseOfRaysFarFromTheOriginAndInAnyUnit) {
  std::uint64_t rasterized = 0;
  for (const float unit : {1e-5F, 1e-2F, 1e3F, 1e6F}) {
    for (const float offset : {0.0F, 1e2F, 1e4F}) {
      Random random(5);
      const glm::vec3 far(offset * unit, -offset * unit, offset * unit);
      scenes::Scene scene;
      scenes::Mesh mesh = soup(random, {0, 0, 3}, 80);
      for (glm::vec3& p : mesh.positions) p = p * unit + far;
      add(scene, mesh);
      add(scene, sphere(8), placed(unit, far));
      scene.instances.push_back({1, placed(0.5F * unit, far + glm::vec3(unit))});
      RenderOptions options = small(64, 48);
      options.integrator = "identity";
      rasterized += expect_same(scene, camera_at(far + glm::vec3(0, 0, 3) * unit, far), options,
                                std::to_string(unit) + " at " + std::to_string(offset));
    }
  }
  expect_some(rasterized);
}

// Many edges, within boxes of instances and at their sides, from afar and near to them.
TEST(FirstHits, AreThoseOfFineMeshesPlacedManyTimes) {
  std::uint64_t rasterized = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Random random(seed);
    scenes::Scene scene;
    add(scene, sphere(40));
    scenes::Mesh box;
    for (const float side : {-1.0F, 1.0F}) {
      add_triangle(box, {-1, -1, side}, {1, -1, side}, {1, 1, side});
      add_triangle(box, {-1, -1, side}, {1, 1, side}, {-1, 1, side});
    }
    add(scene, box, some_transform(random));
    for (int i = 0; i < 6; ++i)
      scene.instances.push_back({static_cast<std::uint32_t>(i % 2), some_transform(random)});
    const glm::vec3 eye = in_cube(random, 1) * (seed % 2 == 0 ? 3.0F : 300.0F);
    scenes::Camera camera = camera_at(eye);
    if (seed % 2 == 1) camera.vertical_fov = 0.5F;
    RenderOptions options = small(180, 130);
    options.integrator = "identity";
    rasterized += expect_same(scene, camera, options, "seed " + std::to_string(seed));
  }
  expect_some(rasterized);
}

// Views along axes: planes that the eye lies in, edges in step with pixels.
TEST(FirstHits, AreThoseOfRaysInBoxesSeenStraight) {
  scenes::Scene scene;
  for (int i = 0; i < 5; ++i) {
    const float x = static_cast<float>(i) - 2.0F;
    add(scene, quad({x, -1, 0}, {0, 2, 0}, {0, 0, 2}));  // from the side for some eye
    add(scene, quad({x, -1, 0}, {1, 0, 0}, {0, 2, 0}));
    add(scene, quad({x, -1, 0}, {1, 0, 0}, {0, 0, 2}));
  }
  RenderOptions options = small(64, 64);
  options.integrator = "identity";
  std::uint64_t rasterized = 0;
  for (const glm::vec3 eye : {glm::vec3(0, 0, 6), glm::vec3(1, 0, 6), glm::vec3(0, -1, 6),
                              glm::vec3(0, 0, 1), glm::vec3(-2, -1, 1)}) {
    rasterized += expect_same(scene, camera_at(eye, eye - glm::vec3(0, 0, 1)), options, "straight");
  }
  expect_some(rasterized);
}

TEST(FirstHits, AreThoseOfGeneratedScenes) {
  for (const char* name : {"gen:cornell", "gen:spheres:3000", "gen:city:4000", "gen:terrain:5000",
                           "gen:field:9000", "gen:machine:2000"}) {
    scenes::Scene scene = scenes::generate(name);
    scenes::complete(scene, scenes::Camera{});
    const scenes::Camera camera =
        scene.cameras.empty() ? scenes::camera_around(scene, "default", 1.5F) : scene.cameras[0];
    RenderOptions options = small(160, 100);
    options.integrator = "identity";
    expect_some(expect_same(scene, camera, options, name));
  }
}

TEST(FirstHits, AreTracedWhereTheyCannotBeKnown) {
  const scenes::Scene scene = some_scene(1, {0, 1, 3});
  const Tracer tracer = make_tracer(scene);
  RenderOptions options = small(40, 30);
  options.primary = Primary::raster_always;
  scenes::Camera lens = camera_at({0, 1, 3}), parallel = lens, none = lens;
  lens.aperture = 0.1F;
  parallel.height = 3.0F;
  none.eye = none.at = {0, 0, 90};  // away from the scene
  none.at.z = 100;
  for (const scenes::Camera& camera : {lens, parallel}) {
    comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
      const Result result = render(communicator, tracer, camera, options);
      EXPECT_FALSE(result.statistics.why_traced.empty());
      EXPECT_EQ(result.statistics.rays.rasterized, 0U);
    });
  }
  BuildOptions fast;
  fast.robust = false;
  const Tracer loose = make_tracer(scene, fast);
  scenes::Scene dotted = scene;
  scenes::Mesh& dots = dotted.meshes.emplace_back();
  dots.shape = {scenes::Shape::Kind::disc, false, 0.05F};
  dots.positions = {{0, 0, 0}};
  dots.triangles = {{0, 0, 0}};
  dotted.instances.push_back({static_cast<std::uint32_t>(dotted.meshes.size() - 1)});
  scenes::complete(dotted, lens);
  const Tracer points = make_tracer(dotted);
  for (const Tracer* of : {&loose, &points}) {
    comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
      const Result result = render(communicator, *of, camera_at({0, 1, 3}), options);
      EXPECT_FALSE(result.statistics.why_traced.empty());
      EXPECT_EQ(result.statistics.rays.rasterized, 0U);
    });
  }
  expect_same(scene, none, options, "away from the scene");
  expect_same(scenes::Scene{}, none, small(8, 8), "empty scene");
}

TEST(FirstHits, AreTheSameForEveryNumberOfRanksAndSchedule) {
  const scenes::Scene scene = some_scene(11, {0, 1, 3});
  const Tracer tracer = make_tracer(scene);
  RenderOptions options = small(90, 60);
  const Result traced = render_alone(scene, camera_at({0, 1, 3}), options);
  options.primary = Primary::raster_always;
  for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
    options.schedule = schedule.name;
    comm::run_threads(3, 2, [&](comm::Communicator& communicator) {
      const Result result = render(communicator, tracer, camera_at({0, 1, 3}), options);
      if (communicator.rank() != 0) return;
      EXPECT_EQ(std::memcmp(traced.image.colour.data(), result.image.colour.data(),
                            traced.image.pixels() * sizeof(image::RgbaF)),
                0)
          << schedule.name;
      expect_some(result.statistics.rays.rasterized);
    });
  }
}

}  // namespace
}  // namespace delray::raytrace
