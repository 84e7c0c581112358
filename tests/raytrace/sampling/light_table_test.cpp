#include "raytrace/sampling/light_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/generate.h"
#include "shading/lighting.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

constexpr std::uint32_t kDrawn = 20000;

// Sample `number` of a pixel.
LightSample draw(const LightTable& table, const shading::Shader& shader, const glm::vec3& from,
                 std::uint64_t pixel, std::uint32_t number) {
  SampleLanes lanes{};
  lanes.set(0, pixel, number, 0);
  Pairs16 pairs[LightTable::kPairs];
  sobol_pairs(lanes, pairs);
  shading::Vectors16 positions;
  positions.set(0, from);
  LightSamples samples;
  const shading::BatchShader batch = shading::make_batch_shader(shader);
  table.sample(batch, positions, 1, pairs, samples);
  return {samples.direction.get(0), samples.distance[0], samples.weight.get(0), samples.pdf[0]};
}

float pdf_of_sky(const LightTable& table, const glm::vec3& direction) {
  shading::Vectors16 directions;
  directions.set(0, direction);
  shading::Floats16 pdfs;
  table.pdf_of_sky(directions, pdfs);
  return pdfs[0];
}

// Irradiance (red) that arrives at `from` on a surface with `normal`, as samples have it.
double estimate(const LightTable& table, const shading::Shader& shader, const glm::vec3& from,
                const glm::vec3& normal) {
  double sum = 0;
  for (std::uint32_t i = 0; i < kDrawn; ++i) {
    const LightSample s = draw(table, shader, from, 99, i);
    sum += s.weight.x * std::max(0.0F, glm::dot(s.direction, normal)) / kDrawn;
  }
  return sum;
}

// The same of triangles that glow with radiance 1, by quadrature.
double irradiance(const scenes::Mesh& mesh, const glm::mat4x3& transform, const glm::vec3& from,
                  const glm::vec3& normal) {
  constexpr int kSide = 60;
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = transform * glm::vec4(mesh.positions[t.x], 1);
    const glm::dvec3 b = transform * glm::vec4(mesh.positions[t.y], 1);
    const glm::dvec3 c = transform * glm::vec4(mesh.positions[t.z], 1);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; i + j < kSide; ++j) {
        for (const double third : {1.0 / 3, 2.0 / 3}) {
          if (third > 0.5 && i + j + 1 >= kSide) continue;
          const glm::dvec3 way = a + (b - a) * ((i + third) / kSide) +
                                 (c - a) * ((j + third) / kSide) - glm::dvec3(from);
          const double d = glm::length(way);
          sum += std::max(0.0, glm::dot(way, glm::dvec3(normal))) * std::abs(glm::dot(n, way)) /
                 std::pow(d, 4) / (2.0 * kSide * kSide);
        }
      }
    }
  }
  return sum;
}

TEST(LightTable, AddsUpLightsOfEveryKind) {
  scenes::Scene scene;
  add(scene, quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}));
  const scenes::Mesh lamp = sphere(4);
  const glm::mat4x3 near = placed(0.3F, {1, 0, 1}), far = placed(0.8F, {-2, 2, 3});
  add(scene, lamp, near).emission = {2.0F, 1.0F, 0.5F};
  scene.instances.push_back({1, far});
  using LightKind = scenes::Light::Kind;
  scenes::Light point, sun, area;
  point.kind = LightKind::point;
  point.colour = glm::vec3(3.0F);
  point.position = {0, -1, 2};
  sun.kind = LightKind::directional;
  sun.colour = glm::vec3(0.4F);
  sun.direction = {0, 0.5F, -1};
  area.kind = LightKind::area;
  area.colour = glm::vec3(1.5F);
  area.position = {-1, -1, 2};
  area.edge_u = {0, 1, 0};
  area.edge_v = {1, 0, 0};  // it shines down
  scene.lights = {point, sun, area};
  scene.environment.up = {0, 0, 1};
  scene.environment.zenith = scene.environment.horizon = glm::vec3(0.25F);

  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  EXPECT_EQ(table.emissive_triangles(), 2 * lamp.triangles.size());
  const glm::vec3 from(0.1F, 0.2F, 0), normal(0, 0, 1);
  double expected = 0;
  for (int i = 0; i < 2; ++i) {
    const shading::Incident light = shading::incident(scene.lights[i], from);
    expected += light.irradiance.x * light.direction.z;
  }
  scenes::Mesh panel = quad(area.position, area.edge_u, area.edge_v);
  expected += 1.5 * irradiance(panel, glm::mat4x3(1.0F), from, normal);
  // The halves of the spheres that look away as well: what hides them is the renderer's to find
  // out.
  expected += 2.0 * (irradiance(lamp, near, from, normal) + irradiance(lamp, far, from, normal));
  expected += 0.25 * M_PI;
  EXPECT_NEAR(estimate(table, shader, from, normal) / expected, 1.0, 0.02);
}

// The triangle of the mesh that holds a point, in world space.
std::uint32_t holding(const scenes::Mesh& mesh, const glm::mat4x3& transform, const glm::vec3& p) {
  double best = 1e30;
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const glm::dvec3 a = transform * glm::vec4(mesh.positions[t.x], 1);
    const glm::dvec3 b = transform * glm::vec4(mesh.positions[t.y], 1);
    const glm::dvec3 c = transform * glm::vec4(mesh.positions[t.z], 1);
    const glm::dvec3 n = glm::cross(b - a, c - a), q(p);
    const double u = glm::dot(glm::cross(q - a, c - a), n) / glm::dot(n, n);
    const double v = glm::dot(glm::cross(b - a, q - a), n) / glm::dot(n, n);
    const double off = std::abs(glm::dot(q - a, n)) / glm::length(n);
    const double error = off + std::max({0.0, -u, -v, u + v - 1});
    if (error < best) best = error, found = i;
  }
  return found;
}

TEST(LightTable, DensitiesAreTheSameFromTheOtherSide) {
  scenes::Scene scene;
  const scenes::Mesh lamp = sphere(5);
  glm::mat4x3 stretched = placed(0.5F, {1, 2, 3});
  stretched[0] = {0.9F, 0.3F, 0.0F};
  add(scene, lamp).emission = glm::vec3(1.0F);
  scene.instances.push_back({0, stretched});
  scene.environment.zenith = glm::vec3(0.01F);
  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  const glm::vec3 from(-2, 0.5F, 4);
  int glow[2] = {0, 0}, sky = 0, differ = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const LightSample s = draw(table, shader, from, 7, i);
    ASSERT_GT(s.pdf, 0.0F);
    if (std::isinf(s.distance)) {
      ++sky;
      differ += std::abs(pdf_of_sky(table, s.direction) / s.pdf - 1.0F) < 1e-3F ? 0 : 1;
      continue;
    }
    const glm::vec3 p = from + s.direction * s.distance;
    const std::uint32_t instance = glm::length(p) < 1.01F ? 0 : 1;
    ++glow[instance];
    const std::uint32_t triangle = holding(lamp, scene.instances[instance].transform, p);
    differ +=
        std::abs(table.pdf_of_hit(instance, triangle, from, p) / s.pdf - 1.0F) < 2e-2F ? 0 : 1;
  }
  EXPECT_LE(differ, 6);  // seen along its edge a triangle's density is anything
  EXPECT_GT(glow[0], 300);
  EXPECT_GT(glow[1], 100);
  EXPECT_GT(sky, 50);
}

TEST(LightTable, AnAreaLightIsMetAtItsLamp) {
  const scenes::Scene scene = scenes::generate("gen:cornell:500");
  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  EXPECT_EQ(table.emissive_triangles(), 0U);
  std::uint32_t lamp = 0;
  while (!(scene.materials[scene.meshes[scene.instances[lamp].mesh].material].emission.x > 0))
    ++lamp;
  const glm::vec3 from(2, 1, 3);
  int met = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const LightSample s = draw(table, shader, from, 8, i);
    if (std::isinf(s.distance)) continue;
    ASSERT_GT(s.pdf, 0.0F);
    ++met;
    const glm::vec3 p = from + s.direction * s.distance;
    ASSERT_NEAR(table.pdf_of_hit(lamp, 0, from, p) / s.pdf, 1.0F, 1e-3F);
  }
  EXPECT_GT(met, 300);
  EXPECT_EQ(table.pdf_of_hit(lamp, 0, from + glm::vec3(0, 10, 0), {2.5F, 5.54F, 2.5F}), 0.0F);
  EXPECT_EQ(table.pdf_of_hit(0, 0, from, {0, 0, 0}), 0.0F);
}

TEST(LightTable, AnAreaLightAloneIsMetByNoRay) {
  scenes::Scene scene = scenes::generate("gen:cornell:500");
  scene.lights[0].edge_u *= 1.1F;  // larger than the lamp
  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  EXPECT_GT(table.emissive_triangles(), 0U);
}

TEST(LightTable, GlowGoesByWhatTheTextureShows) {
  scenes::Scene scene;
  scenes::Mesh wall = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  wall.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scenes::Texture texture;  // the right half glows
  texture.width = 64;
  texture.height = 64;
  for (int i = 0; i < 64 * 64; ++i) {
    const auto code = static_cast<std::uint8_t>(i % 64 < 32 ? 0 : 255);
    texture.texels.push_back({code, code, code, 255});
  }
  scene.textures.push_back(texture);
  scenes::Material& material = add(scene, wall);
  material.emission = glm::vec3(2.0F);
  material.emission_texture = 0;
  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  const glm::vec3 from(0.5F, 0.5F, 1), down(0, 0, -1);
  const scenes::Mesh half = quad({0.5F, 0, 0}, {0.5F, 0, 0}, {0, 1, 0});
  const double expected = 2.0 * irradiance(half, glm::mat4x3(1.0F), from, down);
  EXPECT_NEAR(estimate(table, shader, from, down) / expected, 1.0, 0.02);
}

TEST(LightTable, OfABlackPictureThereIsNothingToDraw) {
  scenes::Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  scenes::Texture texture;
  texture.width = 4;
  texture.height = 2;
  texture.radiance.assign(8, glm::vec3(0.0F));
  scene.textures.push_back(texture);
  scene.environment.texture = 0;
  const shading::Shader shader = shading::make_shader(scene);
  const LightTable table(scene, shader);
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(pdf_of_sky(table, {0, 1, 0}), 0.0F);
  EXPECT_EQ(draw(table, shader, {0, 0, 1}, 1, 0).weight, glm::vec3(0.0F));
}

TEST(LightTable, WithoutLightsThereIsNothingToDraw) {
  scenes::Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  const shading::Shader shader = shading::make_shader(scene);
  for (const LightTable& table : {LightTable(scene, shader), LightTable()}) {
    EXPECT_TRUE(table.empty());
    EXPECT_EQ(draw(table, shader, {0, 0, 1}, 1, 2).weight, glm::vec3(0.0F));
    EXPECT_EQ(table.pdf_of_hit(0, 0, {0, 0, 1}, {0, 0, 0}), 0.0F);
    EXPECT_EQ(pdf_of_sky(table, {0, 1, 0}), 0.0F);
  }
}

}  // namespace
}  // namespace delray::raytrace
