#include "raytrace/sampling/sky_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/sampling/sampler.h"
#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

struct Sky {
  std::vector<shading::Texture> textures;
  shading::Environment environment;
};

// A small bright window in a dim room, sideways.
Sky textured() {
  scenes::Texture texture;
  texture.width = 64;
  texture.height = 32;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool window = x > 10 && x < 16 && y > 8 && y < 12;
      const auto code = static_cast<std::uint8_t>(window ? 255 : 20 + x);
      texture.texels.push_back({code, code, static_cast<std::uint8_t>(code / 2), 255});
    }
  }
  scenes::Environment environment;
  environment.texture = 0;
  environment.up = {0.3F, 1.0F, -0.4F};
  Sky sky;
  sky.textures.push_back(shading::make_texture(texture));
  sky.environment = shading::make_environment(environment, sky.textures);
  return sky;
}

Sky gradient() {
  scenes::Environment environment;
  environment.up = {0, 0, 1};
  environment.zenith = {0.2F, 0.4F, 1.0F};
  environment.horizon = {1.0F, 0.9F, 0.8F};
  Sky sky;
  sky.environment = shading::make_environment(environment, sky.textures);
  return sky;
}

// A sun of many times the light of all else, turned away from where the texture has it.
Sky sunny() {
  scenes::Texture texture;
  texture.width = 256;
  texture.height = 128;
  texture.radiance.assign(256 * 128, glm::vec3(0.3F, 0.5F, 1.0F));
  for (const int y : {30, 31, 32}) {
    for (const int x : {200, 201, 202}) texture.radiance[y * 256 + x] = glm::vec3(5000.0F);
  }
  scenes::Environment environment;
  environment.texture = 0;
  environment.rotation = 100.0F;
  Sky sky;
  sky.textures.push_back(shading::make_texture(texture));
  sky.environment = shading::make_environment(environment, sky.textures);
  return sky;
}

template <class G>
double over_sphere(G g) {
  constexpr int kRows = 512, kColumns = 1024;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double z = (i + 0.5) / kRows * 2 - 1, r = std::sqrt(1 - z * z);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = (j + 0.5) / kColumns * 2 * M_PI;
      sum += g(glm::vec3(r * std::cos(phi), r * std::sin(phi), z));
    }
  }
  return sum * 4 * M_PI / (kRows * kColumns);
}

float pdf(const SkyTable& table, const glm::vec3& direction) {
  shading::Vectors16 directions;
  directions.set(0, direction);
  shading::Floats16 pdfs;
  table.pdf(directions, pdfs);
  return pdfs[0];
}

struct Drawn {
  glm::vec3 direction;
  float pdf;
};

Drawn draw(const SkyTable& table, const glm::vec2& cell, const glm::vec2& place) {
  Pairs16 cells, places;
  cells.x[3] = cell.x, cells.y[3] = cell.y;
  places.x[3] = place.x, places.y[3] = place.y;
  shading::Vectors16 directions;
  shading::Floats16 pdfs;
  table.sample(cells, places, directions, pdfs);
  return {directions.get(3), pdfs[3]};
}

void check(const Sky& sky, double tolerance) {
  const SkyTable table(sky.environment, sky.textures);
  EXPECT_NEAR(over_sphere([&](const glm::vec3& d) { return pdf(table, d); }), 1.0, 5e-3);
  const auto arriving = [&](const glm::vec3& d) {
    return shading::radiance(sky.environment, sky.textures, d).x * std::max(0.0F, d.x + 0.5F * d.y);
  };
  const double expected = over_sphere(arriving);
  constexpr std::uint32_t kSamples = 16384;
  double sum = 0, squares = 0;
  int differ = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const Drawn s = draw(table, sobol_pair(3, i, 0), sobol_pair(3, i, 1));
    ASSERT_GT(s.pdf, 0.0F);
    ASSERT_NEAR(glm::length(s.direction), 1.0F, 1e-5F);
    // At the border of two cells rounding may find the other one.
    differ += std::abs(pdf(table, s.direction) / s.pdf - 1.0F) < 1e-4F ? 0 : 1;
    const double value = arriving(s.direction) / s.pdf;
    sum += value / kSamples;
    squares += value * value / kSamples;
  }
  EXPECT_NEAR(sum / expected, 1.0, tolerance);
  EXPECT_LE(differ, 3);
  // Uniform directions spread more.
  const double uniform =
      over_sphere([&](const glm::vec3& d) { return std::pow(arriving(d), 2) * 4 * M_PI; });
  EXPECT_LT(squares - sum * sum, uniform - expected * expected);
}

TEST(SkyTable, DrawsTexturesByTheirLight) { check(textured(), 0.01); }

TEST(SkyTable, DrawsASunByItsLight) { check(sunny(), 0.01); }

TEST(SkyTable, DrawsGradientsByTheirLight) { check(gradient(), 0.01); }

TEST(SkyTable, IsTheSameOnEveryInstructionSet) {
  for (const Sky& sky : {textured(), sunny(), gradient()}) {
    const SkyTable table(sky.environment, sky.textures);
    SampleLanes lanes{};
    for (int i = 0; i < shading::kBlockPoints; ++i) lanes.set(i, pixel_key(4, i, 0), 7, 0);
    const auto found = [&] {
      Pairs16 pairs[2];
      sobol_pairs(lanes, pairs);
      shading::Vectors16 directions;
      shading::Floats16 drawn, again;
      table.sample(pairs[0], pairs[1], directions, drawn);
      table.pdf(directions, again);
      std::vector<float> all;
      for (int i = 0; i < shading::kBlockPoints; ++i) {
        const glm::vec3 d = directions.get(i);
        all.insert(all.end(), {d.x, d.y, d.z, drawn[i], again[i]});
      }
      return all;
    };
    const std::vector<float> expected = found();
    tests::for_each_target([&] { EXPECT_EQ(found(), expected); });
  }
}

TEST(SkyTable, KnowsHowMuchLightThereIs) {
  for (const Sky& sky : {textured(), gradient()}) {
    const double expected = over_sphere([&](const glm::vec3& d) {
      const glm::vec3 l = shading::radiance(sky.environment, sky.textures, d);
      return (l.x + l.y + l.z) / 3;
    });
    EXPECT_NEAR(SkyTable(sky.environment, sky.textures).integral() / expected, 1.0, 0.01);
  }
}

}  // namespace
}  // namespace delray::raytrace
