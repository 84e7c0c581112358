#include "raytrace/sampling/warp.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace delray::raytrace {
namespace {

constexpr int kGridSide = 256;

template <class F>
void for_grid(F&& f) {
  for (int i = 0; i < kGridSide; ++i) {
    for (int j = 0; j < kGridSide; ++j)
      f(glm::vec2((i + 0.5F) / kGridSide, (j + 0.5F) / kGridSide));
  }
}

TEST(Warp, DiscIsCoveredUniformly) {
  // Rings and sectors of equal area.
  std::vector<int> bins(64, 0);
  for_grid([&](const glm::vec2& u) {
    const glm::vec2 p = disc_point(u);
    const double r2 = static_cast<double>(p.x) * p.x + static_cast<double>(p.y) * p.y;
    ASSERT_LE(r2, 1.000001);
    const double turn = std::atan2(p.y, p.x) / (2 * M_PI) + 0.5;
    bins[static_cast<std::size_t>(std::min(7.0, r2 * 8)) * 8 +
         static_cast<std::size_t>(std::min(7.0, turn * 8))]++;
  });
  for (const int count : bins) EXPECT_NEAR(count, kGridSide * kGridSide / 64, kGridSide);
}

TEST(Warp, CosineDirectionsHaveTheirDensity) {
  double mean_z = 0, mean_z2 = 0;
  for_grid([&](const glm::vec2& u) {
    const glm::vec3 d = cosine_direction(u);
    ASSERT_GE(d.z, 0.0F);
    ASSERT_NEAR(glm::dot(d, d), 1.0F, 1e-5F);
    mean_z += d.z, mean_z2 += d.z * d.z;
  });
  EXPECT_NEAR(mean_z / (kGridSide * kGridSide), 2.0 / 3, 1e-3);
  EXPECT_NEAR(mean_z2 / (kGridSide * kGridSide), 0.5, 1e-3);
}

TEST(Warp, FramesAreOrthonormalAndRightHanded) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 5000; ++i) {
    const glm::vec3 n = i == 0   ? glm::vec3(0, 0, -1)
                        : i == 1 ? glm::vec3(0, 0, 1)
                                 : glm::normalize(glm::vec3(normal(random), normal(random),
                                                            i % 3 == 0 ? -1e4F : normal(random)));
    const Frame frame(n);
    ASSERT_NEAR(glm::dot(frame.x, frame.y), 0.0F, 2e-6F) << "seed 5, try " << i;
    ASSERT_NEAR(glm::dot(frame.x, n), 0.0F, 2e-6F);
    ASSERT_NEAR(glm::length(frame.x), 1.0F, 2e-6F);
    ASSERT_GT(glm::dot(glm::cross(frame.x, frame.y), n), 0.999F);
    const glm::vec3 v(0.3F, -0.5F, 0.8F);
    ASSERT_LT(glm::length(frame.to_local(frame.to_world(v)) - v), 3e-6F);
  }
}

TEST(Warp, HeuristicsOfBothWaysAddUpToOne) {
  EXPECT_FLOAT_EQ(power_heuristic(2.0F, 3.0F) + power_heuristic(3.0F, 2.0F), 1.0F);
  EXPECT_EQ(power_heuristic(2.0F, 0.0F), 1.0F);
  EXPECT_EQ(power_heuristic(1e-30F, 1e30F), 0.0F);
}

}  // namespace
}  // namespace delray::raytrace
