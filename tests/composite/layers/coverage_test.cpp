#include "composite/coverage.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace delray::composite {
namespace {

using Covered = std::function<bool(std::uint64_t pixel)>;

Coverage coverage_of(std::uint64_t pixels, const Covered& covered) {
  return {pixels, [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
            std::uint64_t count = 0;
            for (std::uint64_t i = begin; i < end; ++i) {
              const std::uint64_t bit = covered(i) ? 1 : 0;
              count += bit;
              mask[(i - begin) / 64] |= bit << (i - begin) % 64;
            }
            return count;
          }};
}

std::vector<std::uint64_t> pixels_of(const Coverage& coverage) {
  std::vector<std::uint64_t> result;
  for (std::size_t group = 0; group < coverage.groups(); ++group) {
    EXPECT_EQ(coverage.group(group).covered_before, result.size());
    for_each_covered(coverage, group, [&](std::uint64_t pixel, std::uint64_t k) {
      EXPECT_EQ(coverage.group(group).covered_before + k, result.size());
      result.push_back(pixel);
    });
    EXPECT_EQ(coverage.group(group).covered_before + coverage.group(group).covered, result.size());
  }
  EXPECT_EQ(coverage.covered(), result.size());
  return result;
}

std::vector<std::byte> encoded(const Coverage& coverage) {
  std::vector<std::byte> bytes(coverage.encoded_bytes());
  EXPECT_EQ(coverage.encode(bytes.data()), bytes.data() + bytes.size());
  return bytes;
}

TEST(Coverage, ComesBackFromItsBytes) {
  const std::uint64_t sizes[] = {0, 1, 2, 63, 64, 65, 127, 4095, 4096, 4097, 8192, 20011};
  std::mt19937 random(5);
  std::vector<bool> bits(20011);
  for (auto&& bit : bits) bit = random() % 3 == 0;
  const std::pair<const char*, Covered> shapes[] = {
      {"none", [](std::uint64_t) { return false; }},
      {"all", [](std::uint64_t) { return true; }},
      {"the first", [](std::uint64_t i) { return i == 0; }},
      {"all but the first", [](std::uint64_t i) { return i != 0; }},
      {"every second", [](std::uint64_t i) { return i % 2 == 1; }},
      {"every second 64", [](std::uint64_t i) { return i / 64 % 2 == 1; }},
      {"every second group", [](std::uint64_t i) { return i / 4096 % 2 == 1; }},
      {"from 100 on", [](std::uint64_t i) { return i >= 100; }},
      {"random", [&](std::uint64_t i) { return bits[i]; }},
  };
  for (const std::uint64_t size : sizes) {
    for (const auto& [name, covered] : shapes) {
      SCOPED_TRACE(std::string(name) + " of " + std::to_string(size));
      std::vector<std::uint64_t> expected;
      for (std::uint64_t i = 0; i < size; ++i) {
        if (covered(i)) expected.push_back(i);
      }
      const Coverage found = coverage_of(size, covered);
      EXPECT_EQ(pixels_of(found), expected);
      const std::vector<std::byte> bytes = encoded(found);
      const Coverage decoded(size, bytes);
      EXPECT_EQ(pixels_of(decoded), expected);
      EXPECT_EQ(decoded.encoded_bytes(), bytes.size());
      EXPECT_EQ(encoded(decoded), bytes);
    }
  }
}

TEST(Coverage, TakesAFewBytes) {
  const std::uint64_t width = 1920, height = 1080, size = width * height;
  EXPECT_EQ(coverage_of(size, [](auto) { return false; }).encoded_bytes(), 8U);
  EXPECT_EQ(coverage_of(size, [](auto) { return true; }).encoded_bytes(), 8U);
  const std::uint64_t groups = (size + 4095) / 4096;
  EXPECT_EQ(coverage_of(size, [](auto i) { return i == 7; }).encoded_bytes(),
            8 + (groups * 2 + 7) / 8 * 8 + 16 + 8);
  const double scattered =
      static_cast<double>(coverage_of(size, [](auto i) { return i % 7 == 3; }).encoded_bytes());
  EXPECT_LE(scattered, 0.1295 * static_cast<double>(size));
  const Coverage disc = coverage_of(size, [](std::uint64_t i) {
    const auto x = static_cast<std::int64_t>(i % width) - 960;
    const auto y = static_cast<std::int64_t>(i / width) - 540;
    return x * x + y * y < 440 * 440;
  });
  EXPECT_LE(disc.encoded_bytes(), 880 * 26U);
}

}  // namespace
}  // namespace delray::composite
