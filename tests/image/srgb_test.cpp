#include "image/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace delray::image {
namespace {

double reference_code(double linear) {
  const double value =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return 255 * value;
}

TEST(Srgb, DecodesAsThePowerFunctionDoes) {
  for (int c = 0; c < 256; ++c) {
    const double value = c / 255.0;
    const double expected =
        value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(decode_srgb(static_cast<std::uint8_t>(c)), expected, 1e-7 * expected) << c;
    EXPECT_EQ(decode_srgb_value(static_cast<float>(value)),
              static_cast<float>(internal::srgb_to_linear(static_cast<float>(value))));
  }
  EXPECT_EQ(decode_srgb(0), 0.0F);
  EXPECT_EQ(decode_srgb(255), 1.0F);
  EXPECT_EQ(decode_srgb_value(1.0F), 1.0F);
}

TEST(Srgb, EncodesToTheNearestCode) {
  const auto seed = 20041u;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> exponent(-16, 1);
  for (int k = 0; k < 200000; ++k) {
    const float linear = std::exp2(exponent(random));
    const double exact = std::min(reference_code(linear), 255.0);
    ASSERT_LE(std::abs(encode_srgb(linear) - exact), 0.5 + 1e-4) << linear;
  }
}

TEST(Srgb, StepsExactlyAtTheLeastFloatOfEachCode) {
  for (int c = 1; c < 256; ++c) {
    const float least = internal::kLeastOfCode[static_cast<std::size_t>(c)];
    EXPECT_EQ(encode_srgb(least), c);
    EXPECT_EQ(encode_srgb(std::nextafter(least, 0.0F)), c - 1);
  }
}

TEST(Srgb, EncodesWhatIsOutsideTheRange) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(encode_srgb(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(encode_srgb(-infinity), 0);
  EXPECT_EQ(encode_srgb(-1), 0);
  EXPECT_EQ(encode_srgb(0), 0);
  EXPECT_EQ(encode_srgb(std::numeric_limits<float>::denorm_min()), 0);
  EXPECT_EQ(encode_srgb(std::nextafter(1.0F, 0.0F)), 255);
  EXPECT_EQ(encode_srgb(1), 255);
  EXPECT_EQ(encode_srgb(infinity), 255);
  EXPECT_EQ(encode_alpha(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(encode_alpha(-1), 0);
  EXPECT_EQ(encode_alpha(0.5F), 128);
  EXPECT_EQ(encode_alpha(2), 255);
}

TEST(Srgb, ReturnsEveryPixelOfEightBits) {
  Image8 image(256, 4);
  for (int c = 0; c < 256; ++c) {
    const auto code = static_cast<std::uint8_t>(c);
    const auto i = static_cast<std::size_t>(c);
    image.colour[i] = {code, 0, 0, 255};
    image.colour[256 + i] = {0, code, 0, 1};
    image.colour[512 + i] = {1, 2, code, 0};
    image.colour[768 + i] = {3, 4, 5, code};
  }
  for (std::size_t i = 0; i < image.pixels(); ++i) image.depth[i] = static_cast<float>(i);
  const Image8 back = to_8bit(to_float(image));
  ASSERT_EQ(back.width, 256);
  ASSERT_EQ(back.height, 4);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    ASSERT_EQ(back.colour[i], image.colour[i]) << i;
    ASSERT_EQ(back.depth[i], image.depth[i]) << i;
  }
}

TEST(Srgb, ConvertsEmptyImages) {
  EXPECT_EQ(to_8bit(ImageF(0, 7)).pixels(), 0U);
  EXPECT_EQ(to_float(Image8()).pixels(), 0U);
}

}  // namespace
}  // namespace delray::image
