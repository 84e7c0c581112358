#include "raytrace/sampling/rectangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "raytrace/sampling/sampler.h"

namespace delray::raytrace {
namespace {

// The integral over directions to the shape of g(direction), by area.
template <class G>
double quadrature(const Parallelogram& shape, const glm::vec3& from, G g) {
  constexpr int kSide = 400;
  const glm::dvec3 normal = glm::cross(glm::dvec3(shape.edge_u), glm::dvec3(shape.edge_v));
  double sum = 0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const glm::dvec3 way = glm::dvec3(shape.corner) - glm::dvec3(from) +
                             glm::dvec3(shape.edge_u) * ((i + 0.5) / kSide) +
                             glm::dvec3(shape.edge_v) * ((j + 0.5) / kSide);
      const double distance = glm::length(way);
      sum += g(way / distance) * std::abs(glm::dot(normal, way)) / std::pow(distance, 3);
    }
  }
  return sum / (kSide * kSide);
}

double moment(const glm::dvec3& d) { return 1.0 + std::abs(d.x) + 2.0 * d.y * d.y; }

// Mean of moment / pdf, and how many points do not lie in the shape or whose density is another
// when asked for.
double estimate(const Parallelogram& shape, const glm::vec3& from, int* wrong) {
  constexpr std::uint32_t kSamples = 2048;
  const glm::vec3 normal = glm::cross(shape.edge_u, shape.edge_v);
  const float area2 = glm::dot(normal, normal);
  double sum = 0;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const SurfacePoint p = sample(shape, from, sobol_pair(77, i, 0));
    if (!(p.pdf > 0)) continue;
    const glm::vec3 d = p.position - shape.corner;
    const float s = glm::dot(glm::cross(d, shape.edge_v), normal) / area2;
    const float t = glm::dot(glm::cross(shape.edge_u, d), normal) / area2;
    const bool inside = s > -1e-3F && s < 1.001F && t > -1e-3F && t < 1.001F &&
                        std::abs(glm::dot(d, normal)) < 1e-3F * area2;
    const bool same = std::abs(pdf(shape, from, p.position) / p.pdf - 1.0F) < 1e-3F;
    *wrong += inside && same ? 0 : 1;
    sum += moment(glm::normalize(glm::dvec3(p.position - from))) / p.pdf / kSamples;
  }
  return sum;
}

TEST(Rectangle, DrawsWhatQuadratureSays) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  for (int i = 0; i < 24; ++i) {
    Parallelogram shape;
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    shape.corner = vector();
    shape.edge_u = vector() + glm::vec3(0.3F, 0, 0);
    // Every third is no rectangle.
    shape.edge_v = vector();
    if (i % 3 != 0) shape.edge_v = glm::normalize(glm::cross(shape.edge_u, shape.edge_v)) * 1.5F;
    // Far away, beside, and close before it.
    const float distance = i % 2 == 0 ? 8.0F : 0.2F + 0.1F * static_cast<float>(i % 4);
    const glm::vec3 normal = glm::normalize(glm::cross(shape.edge_u, shape.edge_v));
    const glm::vec3 from = shape.corner + (shape.edge_u + shape.edge_v) * unit(random) +
                           normal * (i % 5 == 0 ? -distance : distance);
    int wrong = 0;
    const double expected = quadrature(shape, from, moment);
    const double got = estimate(shape, from, &wrong);
    // By area a close one has a spread of its own.
    EXPECT_NEAR(got / expected, 1.0, i % 3 == 0 ? 0.03 : 0.004) << "seed 6, try " << i;
    EXPECT_EQ(wrong, 0) << "seed 6, try " << i;
  }
}

TEST(Rectangle, FillsHalfOfTheViewCloseBy) {
  const Parallelogram shape{{-1000, -1000, 1}, {2000, 0, 0}, {0, 2000, 0}};
  EXPECT_NEAR(1.0F / sample(shape, glm::vec3(0.0F), {0.5F, 0.5F}).pdf, 2 * M_PI, 0.01);
}

TEST(Rectangle, InItsPlaneOrWithoutAreaGivesNothing) {
  const Parallelogram square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const glm::vec3 from : {glm::vec3(3, 0.5F, 0), glm::vec3(5, 5, 0), glm::vec3(2, 0, 0)}) {
    const float found = sample(square, from, {0.3F, 0.6F}).pdf;
    EXPECT_TRUE(found == 0.0F) << found;
  }
  EXPECT_EQ(sample(line, {0, 0, 3}, {0.3F, 0.6F}).pdf, 0.0F);
  EXPECT_EQ(sample(Parallelogram{}, {0, 0, 3}, {0.3F, 0.6F}).pdf, 0.0F);
}

}  // namespace
}  // namespace delray::raytrace
