#include "parallel/speed_up.h"

#include <gtest/gtest.h>

#include <vector>

namespace delray::parallel {
namespace {

TEST(SpeedUp, APipelineGainsTheNumberOfItsStagesAtMost) {
  const std::vector<double> stages = {2, 5, 3};
  EXPECT_DOUBLE_EQ(sequential_seconds(stages, 100), 1000);
  EXPECT_DOUBLE_EQ(pipeline_seconds(stages, 100), 10 + 99 * 5);
  EXPECT_DOUBLE_EQ(pipeline_seconds(stages, 1), sequential_seconds(stages, 1));
  const std::vector<double> even = {4, 4, 4};
  EXPECT_NEAR(speed_up(sequential_seconds(even, 1e9), pipeline_seconds(even, 1e9)), 3, 1e-8);
}

TEST(SpeedUp, AmdahlAsTheReportGivesIt) {
  EXPECT_NEAR(amdahl_limit(0.99), 100, 1e-9);
  EXPECT_NEAR(amdahl_speed_up(0.99, 10'000), 99.0197, 1e-4);  // "about 99"
  EXPECT_DOUBLE_EQ(amdahl_speed_up(1, 8), 8);
  EXPECT_DOUBLE_EQ(amdahl_speed_up(0, 8), 1);
  EXPECT_DOUBLE_EQ(amdahl_speed_up(0.5, 4), 1.6);
}

TEST(SpeedUp, KarpAndFlattsFractionIsAmdahlsBackwards) {
  EXPECT_NEAR(serial_fraction(1.6, 4), 0.5, 1e-15);
  EXPECT_NEAR(serial_fraction(4, 8), 1.0 / 7, 1e-15);  // (1/4 - 1/8) / (7/8)
  EXPECT_DOUBLE_EQ(serial_fraction(8, 8), 0);
  EXPECT_LT(serial_fraction(9, 8), 0);
  for (const double q : {0.1, 0.9, 0.999})
    EXPECT_NEAR(serial_fraction(amdahl_speed_up(q, 64), 64), 1 - q, 1e-12);
}

TEST(SpeedUp, EfficiencyAndScalability) {
  EXPECT_DOUBLE_EQ(efficiency(speed_up(12, 3), 8), 0.5);
  EXPECT_DOUBLE_EQ(scalability(9, 6), 1.5);
}

// 100 items, 20 in a cache at 1, others at 5: 420 for one; for two 20 + 30 * 5 = 170.
TEST(SpeedUp, TwoCachesAreMoreThanTwiceAsFast) {
  EXPECT_DOUBLE_EQ(cached_seconds(100, 20, 1, 1, 5), 420);
  EXPECT_DOUBLE_EQ(cached_seconds(100, 20, 2, 1, 5), 170);
  const double s = speed_up(cached_seconds(100, 20, 1, 1, 5), cached_seconds(100, 20, 2, 1, 5));
  EXPECT_GT(s, 2);
  // (2.5): (N t1 - x (t1 - t0)) / (N / 2 t1 - x (t1 - t0)).
  EXPECT_DOUBLE_EQ(s, (100 * 5 - 20 * 4.0) / (50 * 5 - 20 * 4.0));
}

}  // namespace
}  // namespace delray::parallel
