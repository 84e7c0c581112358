// Linear light to and from 8-bit sRGB (IEC 61966-2-1), the same on every machine: tables computed
// at compile time by additions, multiplications and divisions of doubles, no libm.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "image/image.h"

namespace delray::image {

namespace internal {

// y^2.4 for 0 <= y <= 2, within 1e-14 of the value. The fifth root is Newton's from above, which
// descends until rounding stops it.
constexpr double power_2_4(double y) {
  if (y <= 0) return 0;
  double root = y > 1 ? y : 1;
  for (;;) {
    const double fourth = root * root * root * root;
    const double next = (4 * root + y / fourth) / 5;
    if (!(next < root)) break;
    root = next;
  }
  const double square = y * y;
  return square * (root * root);  // y^2 * y^(2/5)
}

constexpr double srgb_to_linear(double code) {
  return code <= 0.04045 ? code / 12.92 : power_2_4((code + 0.055) / 1.055);
}

// Element c is the linear light of code c.
constexpr std::array<float, 256> make_linear_of_code() {
  std::array<float, 256> table{};
  for (int c = 0; c < 256; ++c) {
    table[static_cast<std::size_t>(c)] = static_cast<float>(srgb_to_linear(c / 255.0));
  }
  return table;
}

// Element c, 1 <= c <= 255, is the least float that codes to c; element 256 ends the table.
constexpr std::array<float, 257> make_least_of_code() {
  std::array<float, 257> table{};
  for (int c = 1; c < 256; ++c) {
    const double exact = srgb_to_linear((c - 0.5) / 255.0);
    float least = static_cast<float>(exact);
    if (least < exact) least = std::bit_cast<float>(std::bit_cast<std::uint32_t>(least) + 1);
    table[static_cast<std::size_t>(c)] = least;
  }
  table[256] = std::numeric_limits<float>::infinity();
  return table;
}

// Floats from 2^-13 (below it everything codes to 0) to 1 fall into buckets by exponent and the
// upper 7 bits of the mantissa: narrow enough that at most one code begins within a bucket.
inline constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(0x1p-13F);
inline constexpr int kBucketShift = 16;
inline constexpr std::size_t kBuckets = 13 * 128;

inline constexpr std::array<float, 256> kLinearOfCode = make_linear_of_code();
inline constexpr std::array<float, 257> kLeastOfCode = make_least_of_code();

// Element i is the code of the least float in bucket i.
constexpr std::array<std::uint8_t, kBuckets> make_code_of_bucket() {
  std::array<std::uint8_t, kBuckets> table{};
  std::size_t code = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    const std::uint32_t bits = kFirstBits + static_cast<std::uint32_t>(i << kBucketShift);
    const float least = std::bit_cast<float>(bits);
    while (kLeastOfCode[code + 1] <= least) ++code;
    table[i] = static_cast<std::uint8_t>(code);
  }
  return table;
}
inline constexpr std::array<std::uint8_t, kBuckets> kCodeOfBucket = make_code_of_bucket();

}  // namespace internal

// The linear light, 0 to 1, of an sRGB code.
inline float decode_srgb(std::uint8_t code) { return internal::kLinearOfCode[code]; }

// The linear light of an sRGB value 0 <= value <= 1 that is not a multiple of 1/255 (16-bit files).
// Slow: some 10 divisions.
inline float decode_srgb_value(float value) {
  return static_cast<float>(internal::srgb_to_linear(value));
}

// The nearest sRGB code; values below 0 and NaN give 0, above 1 give 255. Monotone;
// encode_srgb(decode_srgb(c)) = c.
inline std::uint8_t encode_srgb(float linear) {
  if (!(linear >= 0x1p-13F)) return 0;
  if (linear >= 1.0F) return 255;
  const std::uint32_t offset = std::bit_cast<std::uint32_t>(linear) - internal::kFirstBits;
  const std::uint32_t code = internal::kCodeOfBucket[offset >> internal::kBucketShift];
  return static_cast<std::uint8_t>(code + (linear >= internal::kLeastOfCode[code + 1] ? 1 : 0));
}

// Coverage 0 to 1 to the nearest of 0 to 255; NaN gives 0.
inline std::uint8_t encode_alpha(float alpha) {
  if (!(alpha > 0.0F)) return 0;
  return alpha >= 1.0F ? 255 : static_cast<std::uint8_t>(alpha * 255.0F + 0.5F);
}
inline float decode_alpha(std::uint8_t alpha) { return static_cast<float>(alpha) / 255.0F; }

inline Rgba8 to_8bit(const RgbaF& c) {
  return {encode_srgb(c.r), encode_srgb(c.g), encode_srgb(c.b), encode_alpha(c.a)};
}
inline RgbaF to_float(const Rgba8& c) {
  return {decode_srgb(c.r), decode_srgb(c.g), decode_srgb(c.b), decode_alpha(c.a)};
}

// Both forms are premultiplied in linear light, so each channel is converted by itself; depth is
// copied. to_8bit(to_float(image)) = image. O(pixels), parallel.
Image8 to_8bit(const ImageF& image);
ImageF to_float(const Image8& image);

}  // namespace delray::image
