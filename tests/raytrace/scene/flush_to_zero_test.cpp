#include "raytrace/scene/flush_to_zero.h"

#include <gtest/gtest.h>

#include <limits>

namespace delray::raytrace {
namespace {

// Volatile keeps the compiler from computing it beforehand.
float half_of_smallest_normal() {
  volatile float x = std::numeric_limits<float>::min();
  volatile float half = 0.5F;
  return x * half;
}

TEST(FlushToZero, HoldsWhileItLivesAndNoLonger) {
  ASSERT_GT(half_of_smallest_normal(), 0.0F);
  {
    const FlushToZero outer;
#if defined(__SSE__) || defined(__aarch64__)
    EXPECT_EQ(half_of_smallest_normal(), 0.0F);
#endif
    { const FlushToZero inner; }
#if defined(__SSE__) || defined(__aarch64__)
    EXPECT_EQ(half_of_smallest_normal(), 0.0F);
#endif
  }
  EXPECT_GT(half_of_smallest_normal(), 0.0F);
}

}  // namespace
}  // namespace delray::raytrace
