#include "shading/arithmetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace delray::shading {
namespace {

constexpr std::uint32_t kSeed = 7;
constexpr int kTries = 200000;

TEST(Arithmetic, FloorIsFloor) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> x(-1e6F, 1e6F);
  for (int i = 0; i < kTries; ++i) {
    const float v = x(random);
    ASSERT_EQ(static_cast<float>(floor_to_int(v)), std::floor(v)) << "seed " << kSeed;
  }
  EXPECT_EQ(floor_to_int(-1.0F), -1);
  EXPECT_EQ(floor_to_int(-0.0F), 0);
}

TEST(Arithmetic, ClampingLeavesNothingButZeroToOne) {
  EXPECT_EQ(clamp01(-1.0F), 0.0F);
  EXPECT_EQ(clamp01(0.25F), 0.25F);
  EXPECT_EQ(clamp01(7.0F), 1.0F);
  EXPECT_EQ(clamp01(std::numeric_limits<float>::quiet_NaN()), 0.0F);
}

TEST(Arithmetic, LogarithmIsAsAccurateAsStated) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> exponent(-126.0, 127.9);
  for (int i = 0; i < kTries; ++i) {
    const auto x = static_cast<float>(std::exp2(exponent(random)));
    const double exact = std::log2(static_cast<double>(x));
    ASSERT_NEAR(log2(x), exact, 2e-7 * std::max(1.0, std::abs(exact))) << x << " seed " << kSeed;
  }
  EXPECT_EQ(log2(1.0F), 0.0F);
  EXPECT_EQ(log2(8.0F), 3.0F);
  EXPECT_EQ(log2(0.0F), -126.0F);
}

TEST(Arithmetic, PowersAreAsAccurateAsStated) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> exponent(-126.0F, 127.0F), base(0.0F, 4.0F), y(0.1F, 5.0F);
  for (int i = 0; i < kTries; ++i) {
    const float e = exponent(random);
    const double exact = std::exp2(static_cast<double>(e));
    ASSERT_NEAR(exp2(e) / exact, 1.0, 2e-7) << e << " seed " << kSeed;
    const float b = base(random), p = y(random);
    const double power = std::pow(static_cast<double>(b), static_cast<double>(p));
    if (power < 1e-37) continue;
    ASSERT_NEAR(pow(b, p) / power, 1.0, 3e-7 * (1.0 + std::abs(p * std::log2(b))))
        << b << "^" << p << " seed " << kSeed;
  }
  EXPECT_EQ(exp2(0.0F), 1.0F);
  EXPECT_EQ(exp2(10.0F), 1024.0F);
  EXPECT_EQ(pow(0.0F, 2.0F), 0.0F);
  EXPECT_TRUE(std::isfinite(exp2(1e30F)));
  EXPECT_GT(exp2(-1e30F), 0.0F);
}

TEST(Arithmetic, AnglesAreAsAccurateAsStated) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> x(-1.0F, 1.0F), angle(-10.0F, 10.0F);
  for (int i = 0; i < kTries; ++i) {
    const float a = x(random), b = x(random), c = angle(random);
    ASSERT_NEAR(atan2(a, b), std::atan2(static_cast<double>(a), static_cast<double>(b)), 4e-7)
        << a << " " << b << " seed " << kSeed;
    ASSERT_NEAR(acos(a), std::acos(static_cast<double>(a)), 4e-7) << a << " seed " << kSeed;
    const SinCos both = sin_cos(c);
    ASSERT_NEAR(both.sin, std::sin(static_cast<double>(c)), 3e-7) << c << " seed " << kSeed;
    ASSERT_NEAR(both.cos, std::cos(static_cast<double>(c)), 3e-7) << c << " seed " << kSeed;
  }
  EXPECT_EQ(atan2(0.0F, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(atan2(0.0F, -1.0F), kPi);
  EXPECT_FLOAT_EQ(acos(-2.0F), kPi);
  EXPECT_EQ(acos(1.5F), 0.0F);
}

}  // namespace
}  // namespace delray::shading
