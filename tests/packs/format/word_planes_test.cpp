#include "packs/word_planes.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace delray::packs::internal {
namespace {

TEST(WordPlanes, AreExactForAnyBits) {
  const unsigned seed = 3;
  std::mt19937 random(seed);
  for (const std::size_t n : {0U, 1U, 2U, 15U, 16U, 17U, 100U, 2047U, 2048U, 2049U, 5000U}) {
    for (const std::size_t k : {1U, 2U, 3U, 4U}) {
      std::vector<std::uint32_t> values(n * k), back(n * k + 1, 77);
      for (std::uint32_t& value : values) value = random();
      if (n > 2) values[0] = 0x80000000U, values[k] = 0x7FC00001U;
      std::vector<char> bytes(7);
      for (std::size_t j = 0; j < k; ++j) append_planes(values.data() + j, n, k, bytes);
      ASSERT_EQ(bytes.size(), 7 + 4 * k * n);
      read_planes(bytes.data() + 7, n, static_cast<int>(k), back.data());
      ASSERT_EQ(back.back(), 77U) << "beyond the end of " << n << " of " << k;
      back.pop_back();
      ASSERT_EQ(back, values) << n << " of " << k << ", seed " << seed;
    }
  }
}

TEST(WordPlanes, OfNeighboursCompress) {
  std::vector<std::uint32_t> values;
  for (int i = 0; i < 1000; ++i)
    values.push_back(std::bit_cast<std::uint32_t>(0.001F * static_cast<float>(i - 500)));
  std::vector<char> bytes;
  append_planes(values.data(), values.size(), 1, bytes);
  const std::vector<char> small = compress(bytes);
  EXPECT_LT(small.size(), 3 * values.size());
  std::vector<char> back(bytes.size());
  ASSERT_TRUE(decompress(small, back));
  EXPECT_EQ(back, bytes);
  std::vector<char> other(bytes.size() - 1);
  EXPECT_FALSE(decompress(small, other));
}

TEST(WordPlanes, WhatDoesNotCompressStaysAsItIs) {
  std::mt19937 random(1);
  std::vector<char> noise(1000), back(1000);
  for (char& c : noise) c = static_cast<char>(random());
  EXPECT_LE(compress(noise).size(), noise.size());
  EXPECT_TRUE(decompress(compress(noise), back));
  EXPECT_EQ(back, noise);
  EXPECT_TRUE(compress({}).empty());
  EXPECT_TRUE(decompress({}, {}));
}

}  // namespace
}  // namespace delray::packs::internal
