#include "composite/mask.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "image/image.h"

namespace delray::composite {
namespace {

std::vector<bool> bits_of(const PixelMask& mask, PixelRange range) {
  std::vector<bool> result;
  for (std::uint64_t begin = range.begin; begin < range.end; begin += kGroupPixels) {
    const std::uint64_t end = std::min(begin + kGroupPixels, range.end);
    GroupMask bits{};
    std::uint64_t count = mask.read(begin, end, bits);
    for (std::uint64_t i = 0; i < end - begin; ++i) {
      result.push_back((bits[i / 64] >> i % 64 & 1) != 0);
      count -= result.back() ? 1 : 0;
    }
    EXPECT_EQ(count, 0U);
    for (std::uint64_t i = end - begin; i < kGroupPixels; ++i) {
      EXPECT_EQ(bits[i / 64] >> i % 64 & 1, 0U);
    }
  }
  return result;
}

TEST(PixelMask, EqualsAVectorOfBoolUnderRandomChanges) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const std::uint64_t pixels = seed == 0 ? 0 : random() % 20000;
    PixelMask mask(pixels);
    std::vector<bool> expected(pixels);
    EXPECT_TRUE(mask.empty());
    for (int step = 0; step < 40 && pixels > 0; ++step) {
      std::uint64_t begin = random() % pixels, end = random() % (pixels + 1);
      if (begin > end) std::swap(begin, end);
      const int what = static_cast<int>(random() % 3);
      if (what == 0) {
        mask.remove({begin, end});
        for (std::uint64_t i = begin; i < end; ++i) expected[i] = false;
      } else {
        GroupMask bits{};
        for (std::uint64_t i = begin; i < std::min(end, begin + kGroupPixels); ++i) {
          if (random() % 3 == 0) continue;
          bits[(i - begin) / 64] |= std::uint64_t{1} << (i - begin) % 64;
          expected[i] = what == 1;
        }
        if (what == 1) mask.add(begin, bits);
        if (what == 2) mask.remove(begin, bits);
      }
      const std::uint64_t from = random() % pixels;
      EXPECT_EQ(
          bits_of(mask, {from, pixels}),
          std::vector<bool>(expected.begin() + static_cast<std::ptrdiff_t>(from), expected.end()));
      const auto first = expected.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto last = expected.begin() + static_cast<std::ptrdiff_t>(std::max(begin, end));
      EXPECT_EQ(mask.empty({begin, std::max(begin, end)}), std::find(first, last, true) == last);
      EXPECT_EQ(mask.empty(), std::find(expected.begin(), expected.end(), true) == expected.end());
    }
    EXPECT_EQ(bits_of(mask.copy(), {0, pixels}), expected);
  }
}

TEST(MaskMaker, TellsWhatNoLowerRankHides) {
  const std::uint64_t pixels = 9001;
  std::mt19937 random(5);
  std::vector<float> nearest(pixels, image::kEmptyDepth);
  MaskMaker maker;
  for (int rank = 0; rank < 6; ++rank) {
    std::vector<float> depth(pixels, image::kEmptyDepth);
    std::vector<bool> covered(pixels), unhidden(pixels);
    for (std::uint64_t i = 0; i < pixels; ++i) {
      if (random() % 3 == 0) continue;
      depth[i] = static_cast<float>(random() % 4);
      covered[i] = true;
      unhidden[i] = depth[i] < nearest[i];
      nearest[i] = std::min(nearest[i], depth[i]);
    }
    const ImageMasks masks = maker.add(depth);
    EXPECT_EQ(bits_of(masks.covered, {0, pixels}), covered);
    EXPECT_EQ(bits_of(masks.unhidden, {0, pixels}), unhidden);
  }
}

}  // namespace
}  // namespace delray::composite
