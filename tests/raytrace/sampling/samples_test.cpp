#include "raytrace/sampling/samples.h"

#include <gtest/gtest.h>

namespace delray::raytrace {
namespace {

TEST(Samples, OneIsTheCentre) { EXPECT_EQ(sample_position(0, 1), glm::vec2(0.5F)); }

TEST(Samples, LieInThePixelApartAndBalanced) {
  for (int n = 1; n <= 70; ++n) {
    glm::vec2 mean(0.0F);
    for (int i = 0; i < n; ++i) {
      const glm::vec2 p = sample_position(i, n);
      EXPECT_TRUE(p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1) << i << " of " << n;
      for (int j = 0; j < i; ++j) {
        EXPECT_GT(glm::length(p - sample_position(j, n)), 0.5F / static_cast<float>(n));
      }
      mean += p / static_cast<float>(n);
    }
    EXPECT_NEAR(mean.x, 0.5F, 1e-4) << n;
    EXPECT_NEAR(mean.y, 0.5F, 0.6F / static_cast<float>(n)) << n;
  }
}

}  // namespace
}  // namespace delray::raytrace
