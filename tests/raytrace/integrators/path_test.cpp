#include "raytrace/integrators/path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/generate.h"
#include "shading/brdf.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

RenderOptions path_options(int side, int samples) {
  RenderOptions options = small(side, side);
  options.integrator = "path";
  options.samples = samples;
  return options;
}

glm::dvec3 mean(const Result& result) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < result.image.pixels(); ++i) {
    const image::RgbaF& p = result.image.colour[i];
    sum += glm::dvec3(p.r, p.g, p.b);
  }
  return sum / static_cast<double>(result.image.pixels());
}

scenes::Camera inside() {
  scenes::Camera camera;
  camera.eye = {0.2F, 0.1F, 0};
  camera.at = {0, 0, -1};
  camera.vertical_fov = 60;
  return camera;
}

TEST(Path, ClosedLambertianSphereReturnsItsAlbedoSeries) {
  for (const float albedo : {0.3F, 0.8F}) {
    scenes::Scene scene;
    scenes::Material& wall = add(scene, sphere(24));
    wall.base_colour = {albedo, albedo * 0.5F, 0, 1};
    wall.ior = 1.0F;
    wall.emission = {0.5F, 0.5F, 0.5F};
    RenderOptions options = path_options(24, 256);
    for (const int depth : {0, 1, 40}) {
      options.trace.diffuse_depth = depth;
      const glm::dvec3 found = mean(render_alone(scene, inside(), options));
      for (int k = 0; k < 3; ++k) {
        const double a = wall.base_colour[k];
        const double expected = 0.5 * (1 - std::pow(a, depth + 1)) / (1 - a);
        EXPECT_NEAR(found[k], expected, 0.005 * expected) << albedo << " " << depth << " " << k;
      }
    }
  }
}

TEST(Path, WhiteBallsVanishInAWhiteSky) {
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.0F, 0.3F, 1.0F}) {
      for (const float transmission : {0.0F, 1.0F}) {
        scenes::Scene scene;
        scenes::Material& ball = add(scene, sphere(24));
        ball.base_colour = glm::vec4(1);
        ball.metallic = metallic;
        ball.roughness = roughness;
        ball.transmission = transmission;
        scene.environment.zenith = scene.environment.horizon = scene.environment.ground =
            glm::vec3(1);
        scenes::Camera camera;
        camera.eye = {0, 0, 3};
        camera.vertical_fov = 20;  // within the ball
        RenderOptions options = path_options(12, 64);
        options.trace.depth = 64;
        const double found = mean(render_alone(scene, camera, options)).x;
        EXPECT_NEAR(found, 1.0, 0.02) << metallic << " " << roughness << " " << transmission;
      }
    }
  }
}

// Light that goes on for ever in a closed sphere that glows: radiance is emission / (1 - albedo),
// if the albedo is the same for all directions; of white surfaces with what is taken by a tint it
// hardly differs.
double furnace(const scenes::Material& wall) {
  scenes::Scene scene;
  add(scene, sphere(24)) = wall;
  scene.materials[0].emission = glm::vec3(1.0F);
  scene.meshes[0].material = 0;
  RenderOptions options = path_options(16, 64);
  options.trace.depth = options.trace.diffuse_depth = 200;
  return mean(render_alone(scene, inside(), options)).x;
}

// The mean over all viewers of a surface's albedo, weighted by their cosines.
double mean_albedo(const scenes::Material& m) {
  shading::Surface surface;
  surface.base_colour = glm::vec3(m.base_colour);
  surface.metallic = m.metallic;
  surface.roughness = m.roughness;
  surface.ior = m.ior;
  const shading::Lobes lobes = shading::lobes(surface);
  double sum = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    const shading::Response all = shading::response(lobes, static_cast<float>(cosine));
    sum += (all.specular.x + lobes.diffuse.x * all.entering) * 2 * cosine / kSteps;
  }
  return sum;
}

TEST(Path, ClosedFurnacesOfAnyMaterialKeepTheirEnergy) {
  for (const float metallic : {0.0F, 1.0F}) {
    for (const float roughness : {0.0F, 0.2F, 0.5F, 0.8F, 1.0F}) {
      scenes::Material wall;
      wall.base_colour = {0.8F, 0.8F, 0.8F, 1};
      wall.metallic = metallic;
      wall.roughness = roughness;
      const double expected = 1 / (1 - mean_albedo(wall)), found = furnace(wall);
      // In a sphere light that a mirror reflects keeps its angle, here a steep one: nearly 0.8.
      const bool mirror = metallic > 0 && roughness < 0.5F;
      EXPECT_GE(found, 0.97 * (mirror ? 5.0 : expected)) << metallic << " " << roughness;
      EXPECT_LE(found, 1.03 * expected) << metallic << " " << roughness;
      // Light that a rough metal reflects several times takes on its colour as often.
      EXPECT_GE(found, metallic == 0 ? 5.0 : roughness < 0.8F ? 4.0 : 2.5) << roughness;
    }
  }
}

TEST(Path, EndingByChanceChangesNoMean) {
  scenes::Material wall;
  wall.base_colour = {0.9F, 0.9F, 0.9F, 1};
  wall.ior = 1.0F;
  EXPECT_NEAR(furnace(wall), 10.0, 0.2);
}

TEST(Path, MirrorsAndDiffuseSurfacesAreCountedApart) {
  scenes::Scene scene;
  scenes::Material& wall = add(scene, sphere(24));
  wall.base_colour = {0.8F, 0.8F, 0.8F, 1};
  wall.ior = 1.0F;
  wall.emission = glm::vec3(1.0F);
  RenderOptions options = path_options(16, 64);
  options.trace.depth = 0;
  EXPECT_NEAR(mean(render_alone(scene, inside(), options)).x, 5.0, 0.1);
  options.trace.diffuse_depth = 1;
  EXPECT_NEAR(mean(render_alone(scene, inside(), options)).x, 1.8, 0.02);
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0;
  EXPECT_NEAR(mean(render_alone(scene, inside(), options)).x, 1.0, 1e-4);
  options.trace.depth = 1;
  EXPECT_NEAR(mean(render_alone(scene, inside(), options)).x, 1.8, 0.03);
}

// A slab of glass without reflections, seen straight on.
TEST(Path, BodiesOfGlassAbsorbAlongTheWay) {
  scenes::Scene scene;
  scene.environment.zenith = scene.environment.horizon = scene.environment.ground = glm::vec3(1);
  for (const float z : {0.0F, -3.0F}) {
    scenes::Mesh face = quad({-9, -9, z}, {18, 0, 0}, {0, 18, 0});
    if (z < 0) {
      for (glm::uvec3& t : face.triangles) std::swap(t.y, t.z);
    }
    scenes::Material& glass = add(scene, face);
    glass.base_colour = glm::vec4(1);
    glass.transmission = 1;
    glass.ior = 1;
    glass.roughness = 0;
    glass.attenuation_colour = {0.5F, 0.25F, 1};
    glass.attenuation_distance = 1.5F;
    glass.thickness = 3;
  }
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  camera.vertical_fov = 1;
  RenderOptions options = path_options(4, 16);
  for (const char* const integrator : {"path", "whitted"}) {
    options.integrator = integrator;
    const glm::dvec3 found = mean(render_alone(scene, camera, options));
    EXPECT_NEAR(found.x, 0.25, 1e-3) << integrator;
    EXPECT_NEAR(found.y, 0.0625, 1e-3) << integrator;
    EXPECT_NEAR(found.z, 1.0, 1e-3) << integrator;
  }
}

TEST(Path, PanesLetLightPassStraight) {
  scenes::Scene scene;
  scenes::Material& back = add(scene, quad({3.5F, -20, -4}, {20, 0, 0}, {0, 40, 0}));
  back.base_colour = {0, 0, 0, 1};
  back.ior = 1;
  back.emission = {1, 1, 1};
  scenes::Material& pane = add(scene, quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}));
  pane.base_colour = glm::vec4(1);
  pane.transmission = 1;
  pane.roughness = 0;
  scenes::Camera camera;
  camera.eye = {-4, 0, 4};
  camera.at = {0, 0, 0};
  camera.vertical_fov = 4;
  RenderOptions options = path_options(8, 16);
  for (const char* const integrator : {"path", "whitted"}) {
    options.integrator = integrator;
    scene.materials[1].thickness = 0;
    const Result straight = render_alone(scene, camera, options);
    scene.materials[1].thickness = 1;
    const Result bent = render_alone(scene, camera, options);
    EXPECT_GT(mean(straight).x, 0.9) << integrator;  // straight on to x = 4
    EXPECT_LT(mean(bent).x, 1e-3) << integrator;     // bent to x = 2.1, past the plate
  }
}

TEST(Path, UnlitSurfacesLookAlikeInAllIntegrators) {
  scenes::Scene scene;
  scenes::Material& wall = add(scene, quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}));
  wall.base_colour = {0.25F, 0.5F, 0.75F, 1};
  wall.unlit = true;
  scene.environment.zenith = glm::vec3(3);
  scenes::Light light;
  light.direction = {0, 0, -1};
  scene.lights.push_back(light);
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  RenderOptions options = path_options(4, 4);
  for (const char* const integrator : {"path", "whitted", "direct"}) {
    options.integrator = integrator;
    const glm::dvec3 found = mean(render_alone(scene, camera, options));
    EXPECT_NEAR(found.x, 0.25, 1e-6) << integrator;
    EXPECT_NEAR(found.z, 0.75, 1e-6) << integrator;
  }
}

TEST(Path, LightsOfNoSizeLightExactly) {
  scenes::Scene scene;
  scenes::Material& floor = add(scene, quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}));
  floor.base_colour = glm::vec4(0.5F, 0.5F, 0.5F, 1);
  floor.ior = 1.0F;
  scenes::Light light;
  light.kind = scenes::Light::Kind::point;
  light.position = {0, 2, 0};
  light.colour = glm::vec3(4);
  scene.lights.push_back(light);
  scenes::Camera camera;
  camera.eye = {0, 4, 0.01F};
  camera.vertical_fov = 1;
  const Result result = render_alone(scene, camera, path_options(4, 4));
  EXPECT_NEAR(mean(result).x, 4.0 / 4.0 * 0.5 / M_PI, 1e-3);
}

TEST(Path, CutOutsAndVeilsLetThroughWhatTheyShould) {
  scenes::Scene scene;
  scenes::Material& back = add(scene, quad({-20, -20, -1}, {40, 0, 0}, {0, 40, 0}));
  back.base_colour = {0, 0, 0, 1};
  back.ior = 1;
  back.emission = {0, 0, 1};
  scenes::Material& veil = add(scene, quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}));
  veil.base_colour = {0, 0, 0, 0.25F};
  veil.ior = 1;
  veil.emission = {1, 0, 0};
  veil.alpha = scenes::Material::Alpha::blend;
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  const glm::dvec3 found = mean(render_alone(scene, camera, path_options(16, 64)));
  EXPECT_NEAR(found.x, 0.25, 0.005);
  EXPECT_NEAR(found.z, 0.75, 0.005);
}

// Mean squared difference of pixels.
double difference(const Result& a, const Result& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    const image::RgbaF &p = a.image.colour[i], &q = b.image.colour[i];
    sum += (p.r - q.r) * (p.r - q.r) + (p.g - q.g) * (p.g - q.g) + (p.b - q.b) * (p.b - q.b);
  }
  return sum / static_cast<double>(a.image.pixels());
}

// Errors of independent samples: (variance / few + variance / many). A biased picture does not come
// closer with more samples.
TEST(Path, CornellBoxConvergesToItsReference) {
  const scenes::Scene scene = scenes::generate("gen:cornell");
  ASSERT_FALSE(scene.cameras.empty());
  RenderOptions options = path_options(8, 4096);
  options.trace.depth = 6;
  options.trace.seed = 1;
  const Result reference = render_alone(scene, scene.cameras[0], options);
  double few = 0, many = 0;
  glm::dvec3 sum(0.0);
  for (const std::uint64_t seed : {2, 3, 4}) {
    options.trace.seed = seed;
    options.samples = 16;
    few += difference(render_alone(scene, scene.cameras[0], options), reference);
    options.samples = 256;
    const Result more = render_alone(scene, scene.cameras[0], options);
    many += difference(more, reference);
    sum += mean(more);
  }
  EXPECT_LT(many, few / 8);
  EXPECT_GT(few, 0.0);
  const glm::dvec3 b = mean(reference);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k] / 3, b[k], 0.02 * b[k]);
}

// With assertions Embree ends the process over rays that take no part, if they are not numbers.
TEST(Path, InstancesAreTracedOnEveryInstructionSet) {
  scenes::Scene scene;
  add(scene, sphere(8), placed(0.4F, {-0.5F, 0, 0}));
  for (int i = 0; i < 20; ++i) {
    scene.instances.push_back(
        {0, placed(0.3F, {0.3F * static_cast<float>(i % 5), 0.2F, -0.5F * i})});
  }
  scene.environment.zenith = scene.environment.horizon = glm::vec3(0.5F);
  scenes::Camera camera;
  camera.eye = {0, 0, 4};
  const double expected = mean(render_alone(scene, camera, path_options(40, 4))).x;
  for (const char* isa : {"sse4.2", "avx", "avx2"}) {
    RenderOptions options = path_options(40, 4);
    options.build.isa = isa;
    EXPECT_NEAR(mean(render_alone(scene, camera, options)).x, expected, 1e-3) << isa;
  }
}

// Powers of two leave all mantissas as they are.
TEST(Path, PicturesDoNotDependOnTheUnitOfLength) {
  const auto picture = [](float scale, bool by_transform, const char* integrator) {
    scenes::Scene scene;
    scenes::Mesh ball = sphere(8);
    scenes::Mesh floor = quad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6});
    for (scenes::Mesh* mesh : {&ball, &floor}) {
      for (glm::vec3& p : mesh->positions) p *= by_transform ? 1.0F : scale;
    }
    const glm::mat4x3 transform = placed(by_transform ? scale : 1.0F, {0, 0, 0});
    add(scene, ball, transform);
    add(scene, floor, transform);
    scenes::Light light;
    light.direction = {-0.3F, -1, -0.4F};
    light.colour = glm::vec3(3);
    scene.lights.push_back(light);
    scene.environment.zenith = scene.environment.horizon = glm::vec3(0.5F);
    scenes::Camera camera;
    camera.eye = glm::vec3(1, 2, 6) * scale;
    RenderOptions options = path_options(24, 4);
    options.integrator = integrator;
    return render_alone(scene, camera, options);
  };
  for (const char* integrator : {"path", "whitted"}) {
    const Result expected = picture(1.0F, false, integrator);
    for (const float scale : {0x1p-24F, 0x1p36F}) {
      for (const bool by_transform : {false, true}) {
        const Result found = picture(scale, by_transform, integrator);
        EXPECT_LT(difference(found, expected), 1e-4) << scale << by_transform << integrator;
      }
    }
  }
}

TEST(Path, TransparentBackgroundShowsInAlpha) {
  scenes::Scene scene;
  add(scene, quad({0, -50, 0}, {50, 0, 0}, {0, 100, 0}));
  scene.environment.horizon = {1, 1, 1};
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  RenderOptions options = path_options(6, 4);
  options.trace.background = TraceOptions::Background::transparent;
  const Result result = render_alone(scene, camera, options);
  EXPECT_EQ(pixel(result, 1, 2), (image::RgbaF{0, 0, 0, 0}));
  EXPECT_EQ(pixel(result, 4, 2).a, 1.0F);
}

TEST(Ao, OpenPlainIsWhiteClosedBoxIsBlackEdgeIsHalf) {
  scenes::Scene scene;
  add(scene, quad({-1000, 0, 1000}, {2000, 0, 0}, {0, 0, -2000}));
  scenes::Camera camera;
  camera.eye = {0, 0.05F, 2};
  camera.at = {0, 0, 0};
  camera.vertical_fov = 1;
  RenderOptions options = path_options(8, 64);
  options.integrator = "ao";
  EXPECT_EQ(mean(render_alone(scene, camera, options)).x, 1.0);
  add(scene, quad({-1000, 0, -0.001F}, {2000, 0, 0}, {0, 1000, 0}));  // a wall right behind
  camera.eye = {0, 0.5F, 0.5F};
  camera.vertical_fov = 0.01F;
  EXPECT_NEAR(mean(render_alone(scene, camera, options)).x, 0.5, 0.02);
  options.trace.reach = 1e-4F;  // shorter than the way to the wall
  EXPECT_NEAR(mean(render_alone(scene, camera, options)).x, 1.0, 0.02);
  add(scene, sphere(), placed(100, {0, 0, 0}));
  options.trace.reach = std::numeric_limits<float>::infinity();
  EXPECT_EQ(mean(render_alone(scene, camera, options)).x, 0.0);
}

TEST(Direct, WithoutShadowsNothingStandsInTheWayOfLight) {
  scenes::Scene scene;
  add(scene, quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0})).ior = 1.0F;
  add(scene, quad({-20, -20, 8}, {40, 0, 0}, {0, 40, 0}));  // behind the camera
  scenes::Light light;
  scene.lights.push_back(light);
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  RenderOptions options = small(8, 8);
  options.integrator = "direct";
  const Result shadowed = render_alone(scene, camera, options);
  EXPECT_EQ(pixel(shadowed, 4, 4).g, 0.0F);
  EXPECT_EQ(shadowed.statistics.rays.shadow, 64U);
  options.trace.shadows = false;
  const Result lit = render_alone(scene, camera, options);
  EXPECT_NEAR(pixel(lit, 4, 4).g, 0.8F / static_cast<float>(M_PI), 1e-5);
  EXPECT_EQ(lit.statistics.rays.shadow, 0U);
  EXPECT_NEAR(depth(lit, 4, 4), 5.0F, 1e-5);
}

TEST(Lens, WhatIsAtTheFocusIsSharp) {
  scenes::Scene scene;
  scenes::Material& half = add(scene, quad({0, -50, 0}, {50, 0, 0}, {0, 100, 0}));
  half.emission = {1, 1, 1};
  half.base_colour = {0, 0, 0, 1};
  half.ior = 1;
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  camera.aperture = 1;
  RenderOptions options = small(16, 16);
  options.samples = 16;
  const Result sharp = render_alone(scene, camera, options);
  EXPECT_EQ(pixel(sharp, 7, 8).r, 0.0F);
  EXPECT_NEAR(pixel(sharp, 8, 8).r, 1.0F, 1e-5);
  camera.focus = 2.5F;
  const Result blurred = render_alone(scene, camera, options);
  EXPECT_GT(pixel(blurred, 7, 8).r, 0.1F);
  EXPECT_LT(pixel(blurred, 8, 8).r, 0.9F);
}

}  // namespace
}  // namespace delray::raytrace
