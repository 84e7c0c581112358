#include "raytrace/integrators/whitted.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

// Looks along -z at the origin from a distance of 5.
scenes::Camera ahead() {
  scenes::Camera camera;
  camera.eye = {0, 0, 5};
  camera.vertical_fov = 30;
  return camera;
}

scenes::Mesh wall(float z, float half = 20.0F) {
  return quad({-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0});
}

void expect_same(const Result& a, const Result& b, float tolerance) {
  ASSERT_EQ(a.image.pixels(), b.image.pixels());
  for (std::size_t i = 0; i < a.image.pixels(); ++i) {
    const image::RgbaF &p = a.image.colour[i], &q = b.image.colour[i];
    ASSERT_NEAR(p.r, q.r, tolerance) << i;
    ASSERT_NEAR(p.g, q.g, tolerance) << i;
    ASSERT_NEAR(p.b, q.b, tolerance) << i;
    ASSERT_NEAR(p.a, q.a, tolerance) << i;
  }
}

TEST(Whitted, EmptySceneShowsTheEnvironment) {
  scenes::Scene scene;
  scene.environment.horizon = scene.environment.zenith = scene.environment.ground = {1, 2, 3};
  const Result result = render_alone(scene, ahead(), small(7, 5));
  EXPECT_EQ(pixel(result, 3, 2), (image::RgbaF{1, 2, 3, 1}));
  EXPECT_EQ(depth(result, 3, 2), image::kEmptyDepth);
  RenderOptions options = small(7, 5);
  options.trace.background = TraceOptions::Background::transparent;
  EXPECT_EQ(pixel(render_alone(scene, ahead(), options), 3, 2), (image::RgbaF{0, 0, 0, 0}));
  EXPECT_EQ(result.statistics.rays.primary, 35U);
}

TEST(Whitted, EmissionShowsItself) {
  scenes::Scene scene;
  scenes::Material& material = add(scene, wall(0));
  material.emission = {0.5F, 0.25F, 0.125F};
  material.base_colour = glm::vec4(0, 0, 0, 1);
  const Result result = render_alone(scene, ahead(), small());
  EXPECT_EQ(pixel(result, 0, 31), (image::RgbaF{0.5F, 0.25F, 0.125F, 1}));
  EXPECT_NEAR(depth(result, 0, 31), 5.0F, 1e-5);  // along the axis, in the corner too
}

TEST(Whitted, ShadowsAreWhereTheyBelong) {
  scenes::Scene scene;
  add(scene, wall(0)).ior = 1.0F;
  add(scene, quad({0, -20, 1}, {20, 0, 0}, {0, 40, 0}));  // hides the light from x > 0
  scenes::Light light;
  light.direction = {0, 0, -1};
  scene.lights.push_back(light);
  scenes::Camera camera = ahead();
  camera.eye = {0, 0, 0.9F};  // between wall and blocker
  const Result result = render_alone(scene, camera, small());
  const float lit = 0.8F / static_cast<float>(M_PI);
  for (int y = 0; y < 32; ++y) {
    EXPECT_NEAR(pixel(result, 10, y).g, lit, 1e-5);
    EXPECT_EQ(pixel(result, 20, y).g, 0.0F);
  }
  EXPECT_EQ(result.statistics.rays.shadow, 32U * 32U);
}

TEST(Whitted, NothingShadowsItself) {
  // Far from the origin, tiny and huge, moved and instanced: every point of a sphere that faces the
  // light is lit.
  for (const float scale : {1e-3F, 1.0F, 1e4F}) {
    for (const glm::vec3& centre : {glm::vec3(0.0F), glm::vec3(1000, -2000, 3000)}) {
      scenes::Scene scene;
      scenes::Mesh ball = sphere(24);
      ball.normals.clear();  // flat shading: the light is above every lit facet's horizon
      add(scene, ball, placed(scale, centre * scale)).ior = 1.0F;
      scenes::Light light;
      light.direction = {0, 0, -1};
      scene.lights.push_back(light);
      scenes::Camera camera;
      camera.eye = (centre + glm::vec3(0, 0, 5)) * scale;
      camera.at = centre * scale;
      camera.vertical_fov = 30;
      for (const bool instanced : {false, true}) {
        if (instanced) {
          scene.instances.push_back(scene.instances[0]);
          scene.instances.back().transform[3].z -= 50 * scale;
        }
        const Result result = render_alone(scene, camera, small(64, 64));
        int dark = 0, seen = 0;
        for (int i = 0; i < 64 * 64; ++i) {
          const bool hit = result.image.depth[i] < 10 * scale;
          seen += hit ? 1 : 0;
          dark += hit && result.image.colour[i].g <= 0.0F ? 1 : 0;
        }
        EXPECT_GT(seen, 1000) << scale << " " << centre.x << " " << instanced;
        EXPECT_EQ(dark, 0) << scale << " " << centre.x << " " << instanced;
      }
    }
  }
}

TEST(Whitted, MirrorShowsWhatIsBehindTheCamera) {
  scenes::Scene scene;
  scenes::Material& mirror = add(scene, wall(0));
  mirror.metallic = 1;
  mirror.roughness = 0;
  mirror.base_colour = {1, 0.5F, 1, 1};
  scenes::Material& left = add(scene, quad({-30, -30, 10}, {0, 60, 0}, {30, 0, 0}));
  left.base_colour = {0, 0, 0, 1};
  left.emission = {1, 1, 0};
  const Result result = render_alone(scene, ahead(), small());
  const image::RgbaF seen = pixel(result, 8, 16), empty = pixel(result, 24, 16);
  EXPECT_NEAR(seen.r, 1.0F, 1e-3);
  EXPECT_NEAR(seen.g, 0.5F, 1e-2);
  EXPECT_EQ(seen.b, 0.0F);
  EXPECT_EQ(empty.r, 0.0F);
  EXPECT_EQ(result.statistics.rays.secondary, 32U * 32U);
}

TEST(Whitted, DepthZeroSendsNoSecondaryRays) {
  scenes::Scene scene;
  scenes::Material& mirror = add(scene, sphere());
  mirror.metallic = 1;
  mirror.roughness = 0;
  scene.environment.horizon = scene.environment.zenith = scene.environment.ground = glm::vec3(1);
  RenderOptions options = small();
  options.trace.depth = 0;
  const Result none = render_alone(scene, ahead(), options);
  EXPECT_EQ(none.statistics.rays.secondary, 0U);
  options.trace.depth = 1;
  const Result one = render_alone(scene, ahead(), options);
  EXPECT_GT(one.statistics.rays.secondary, 0U);
  expect_same(none, one, 0.08F);  // the same environment all around, once by approximation
}

TEST(Whitted, ReflectionsEndAtTheGivenDepth) {
  scenes::Scene scene;
  for (const float z : {0.0F, 6.0F}) {
    scenes::Material& mirror = add(scene, wall(z));
    mirror.metallic = 1;
    mirror.roughness = 0;
    mirror.base_colour = glm::vec4(1);
  }
  for (const int levels : {1, 3, 8}) {
    RenderOptions options = small(8, 8);
    options.trace.depth = levels;
    EXPECT_EQ(render_alone(scene, ahead(), options).statistics.rays.secondary,
              static_cast<std::uint64_t>(64 * levels));
  }
}

TEST(Whitted, GlassOfIndexOneIsInvisible) {
  scenes::Scene scene;
  add(scene, wall(-3)).ior = 1.0F;
  scene.materials[0].base_colour = {0.2F, 0.5F, 0.9F, 1};
  scenes::Light light;
  light.direction = {0.3F, -0.2F, -1};
  light.colour = {3, 3, 3};
  scene.lights.push_back(light);
  scene.environment.horizon = {0.4F, 0.4F, 0.4F};
  const Result without = render_alone(scene, ahead(), small());
  scenes::Material& glass = add(scene, sphere());
  glass.transmission = 1;
  glass.ior = 1;
  glass.base_colour = glm::vec4(1);
  const Result with = render_alone(scene, ahead(), small());
  expect_same(without, with, 1e-4F);
  EXPECT_LT(depth(with, 16, 16), depth(without, 16, 16));  // yet it is there
}

TEST(Whitted, GlassBallTurnsTheWorldUpsideDown) {
  scenes::Scene scene;
  scenes::Material& ball = add(scene, sphere(64));
  ball.transmission = 1;
  ball.ior = 1.5F;
  ball.base_colour = glm::vec4(1);
  scene.environment.zenith = {0, 0, 1};
  scene.environment.horizon = {0, 0, 0};
  scene.environment.ground = {1, 0, 0};
  const Result result = render_alone(scene, ahead(), small(64, 64));
  const image::RgbaF upper = pixel(result, 32, 25), lower = pixel(result, 32, 39);
  EXPECT_GT(upper.r, 3 * upper.b);
  EXPECT_GT(lower.b, 3 * lower.r);
}

TEST(Whitted, TotalInternalReflectionKeepsLightInside) {
  // From within glass, a plane surface seen at a grazing angle mirrors; seen head on it lets
  // through.
  scenes::Scene scene;
  scenes::Material& surface = add(scene, wall(0, 1000.0F));
  surface.transmission = 1;
  surface.ior = 1.5F;
  surface.base_colour = glm::vec4(1);
  scenes::Material& lamp = add(scene, wall(50, 5000.0F));  // faces away; above in the surface
  lamp.base_colour = {0, 0, 0, 1};
  lamp.emission = {1, 0, 0};
  scenes::Material& inside = add(scene, wall(-50, 5000.0F));
  inside.base_colour = {0, 0, 0, 1};
  inside.emission = {0, 1, 0};
  scene.materials[1].ior = inside.ior = 1.0F;  // what glows lights what else there is
  scenes::Camera camera;
  camera.eye = {0, 0, -5};  // the side that the normal points away from: inside
  camera.up = {0, 1, 0};
  camera.vertical_fov = 1;
  camera.at = {0, 0, 0};
  const image::RgbaF straight = pixel(render_alone(scene, camera, small(4, 4)), 2, 2);
  EXPECT_NEAR(straight.r, 0.96F, 0.01F);
  EXPECT_NEAR(straight.g, 0.04F, 0.01F);
  camera.at = {10, 0, 0};  // 63 degrees; the critical angle is 42
  const image::RgbaF slanted = pixel(render_alone(scene, camera, small(4, 4)), 2, 2);
  EXPECT_NEAR(slanted.r, 0.0F, 1e-6);
  EXPECT_NEAR(slanted.g, 1.0F, 1e-5);
}

TEST(Whitted, CutOutsAndBlendsShowWhatIsBehind) {
  scenes::Scene scene;
  scenes::Material& back = add(scene, wall(-1));
  back.base_colour = {0, 0, 0, 1};
  back.ior = 1.0F;
  back.emission = {0, 0, 1};
  scenes::Material& veil = add(scene, wall(0));
  veil.base_colour = {0, 0, 0, 0.25F};
  veil.ior = 1;
  veil.emission = {1, 0, 0};
  veil.alpha = scenes::Material::Alpha::blend;
  const Result blended = render_alone(scene, ahead(), small(8, 8));
  EXPECT_NEAR(pixel(blended, 4, 4).r, 0.25F, 1e-6);
  EXPECT_NEAR(pixel(blended, 4, 4).b, 0.75F, 1e-6);
  EXPECT_NEAR(depth(blended, 4, 4), 5.0F, 1e-5);
  scene.materials[1].alpha = scenes::Material::Alpha::mask;
  const Result cut = render_alone(scene, ahead(), small(8, 8));
  EXPECT_EQ(pixel(cut, 4, 4).r, 0.0F);
  EXPECT_EQ(pixel(cut, 4, 4).b, 1.0F);
  EXPECT_NEAR(depth(cut, 4, 4), 6.0F, 1e-5);
  scene.instances.erase(scene.instances.begin());
  RenderOptions options = small(8, 8);
  options.trace.background = TraceOptions::Background::transparent;
  scene.materials[1].alpha = scenes::Material::Alpha::blend;
  EXPECT_NEAR(pixel(render_alone(scene, ahead(), options), 4, 4).a, 0.25F, 1e-6);
}

TEST(Whitted, SeeThroughLayersCastLightShadows) {
  for (const int layers : {0, 1, 3}) {
    scenes::Scene scene;
    add(scene, wall(0)).ior = 1.0F;
    for (int i = 0; i < layers; ++i) {
      scenes::Material& veil = add(scene, wall(6.0F + static_cast<float>(i)));  // behind the camera
      veil.alpha = scenes::Material::Alpha::blend;
      veil.base_colour = {1, 1, 1, 0.5F};
    }
    scenes::Light light;
    light.kind = scenes::Light::Kind::point;
    light.position = {0, 0, 100};
    light.colour = glm::vec3(1e4F);
    scene.lights.push_back(light);
    const Result result = render_alone(scene, ahead(), small(8, 8));
    const float lit = 0.8F / static_cast<float>(M_PI) * std::pow(0.5F, static_cast<float>(layers));
    EXPECT_NEAR(pixel(result, 4, 4).g, lit, 2e-3F * lit) << layers;
  }
}

TEST(Whitted, NearPlaneCutsAway) {
  scenes::Scene scene;
  add(scene, wall(2)).emission = {1, 0, 0};
  add(scene, wall(0)).emission = {0, 1, 0};
  for (scenes::Material& material : scene.materials) {  // neither lights the other
    material.base_colour = {0, 0, 0, 1};
    material.ior = 1.0F;
  }
  scenes::Camera camera = ahead();
  camera.near = 4;
  EXPECT_EQ(pixel(render_alone(scene, camera, small(4, 4)), 2, 2).r, 0.0F);
  EXPECT_EQ(pixel(render_alone(scene, camera, small(4, 4)), 2, 2).g, 1.0F);
}

}  // namespace
}  // namespace delray::raytrace
