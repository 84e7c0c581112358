#include "raytrace/sampling/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/targets.h"

namespace delray::raytrace {
namespace {

// Whether points [first, first + 2^k) of a pair have exactly one point in each of the boxes that
// are 2^-i wide and 2^(i-k) high.
bool stratified(std::uint64_t pixel, std::uint32_t dimension, std::uint32_t first, int k, int i) {
  const std::uint32_t n = 1U << k;
  std::vector<char> taken(n, 0);
  for (std::uint32_t s = first; s < first + n; ++s) {
    const glm::vec2 p = sobol_pair(pixel, s, dimension);
    const auto column = static_cast<std::uint32_t>(std::ldexp(p.x, i));
    const auto row = static_cast<std::uint32_t>(std::ldexp(p.y, k - i));
    char& box = taken[(column << (k - i)) + row];
    if (box != 0) return false;
    box = 1;
  }
  return true;
}

TEST(Sampler, AlignedPowersOfTwoAreStratifiedInEveryBox) {
  for (std::uint32_t d = 0; d < 12; ++d) {
    const std::uint64_t pixel = pixel_key(1, static_cast<int>(d) * 37, 5);
    for (int k = 0; k <= 10; ++k) {
      const std::uint32_t n = 1U << k;
      for (int i = 0; i <= k; ++i) {
        EXPECT_TRUE(stratified(pixel, d, 0, k, i)) << d << " " << k << " " << i;
        EXPECT_TRUE(stratified(pixel, d, 5 * n, k, i)) << d << " " << k << " " << i;
      }
    }
  }
}

TEST(Sampler, SingleDimensionsAreStratifiedToo) {
  for (std::uint32_t d = 0; d < 40; ++d) {
    const std::uint64_t pixel = pixel_key(2, 3, static_cast<int>(d));
    std::set<std::uint32_t> cells;
    for (std::uint32_t s = 0; s < 256; ++s)
      cells.insert(static_cast<std::uint32_t>(sobol(pixel, s, d) * 256.0F));
    EXPECT_EQ(cells.size(), 256U) << d;
  }
}

TEST(Sampler, EveryNumberIsBelowOneAndNotNegative) {
  for (int x = 0; x < 50000; ++x) {
    const glm::vec2 p = sobol_pair(pixel_key(3, x, 0), static_cast<std::uint32_t>(x), 4);
    ASSERT_TRUE(p.x >= 0.0F && p.x < 1.0F && p.y >= 0.0F && p.y < 1.0F);
  }
}

// A function of a pixel, to be compared with another one.
using Number = float (*)(int x, int y);

double correlation(Number a, Number b) {
  constexpr int kSide = 200;
  double sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double u = a(x, y), v = b(x, y);
      sum_a += u, sum_b += v, sum_aa += u * u, sum_bb += v * v, sum_ab += u * v;
    }
  }
  constexpr double n = kSide * kSide;
  return (sum_ab / n - sum_a / n * (sum_b / n)) /
         std::sqrt((sum_aa / n - std::pow(sum_a / n, 2)) * (sum_bb / n - std::pow(sum_b / n, 2)));
}

TEST(Sampler, NothingIsCorrelatedFromPixelToPixelOrDimensionToDimension) {
  const Number here = [](int x, int y) { return sobol_pair(pixel_key(4, x, y), 3, 7).x; };
  const Number others[] = {
      [](int x, int y) { return sobol_pair(pixel_key(4, x + 1, y), 3, 7).x; },
      [](int x, int y) { return sobol_pair(pixel_key(4, x, y + 1), 3, 7).x; },
      [](int x, int y) { return sobol_pair(pixel_key(4, y, x), 3, 7).x + 1e-9F * (x == y); },
      [](int x, int y) { return sobol_pair(pixel_key(5, x, y), 3, 7).x; },
      [](int x, int y) { return sobol_pair(pixel_key(4, x, y), 3, 7).y; },
      [](int x, int y) { return sobol_pair(pixel_key(4, x, y), 3, 8).x; },
      [](int x, int y) { return sobol_pair(pixel_key(4, x, y), 3, 6).y; },
      [](int x, int y) { return sobol(pixel_key(4, x, y), 3, 7); },
      [](int x, int y) { return sobol(pixel_key(4, x, y), 3, 8); },
  };
  // 40000 pairs of independent numbers: deviation 0.005. The diagonal of the third is 1 in 200.
  for (const Number other : others) EXPECT_LT(std::abs(correlation(here, other)), 0.025);
  EXPECT_GT(correlation(here, here), 0.999);
}

TEST(Sampler, EachSampleIsUniformOverPixels) {
  constexpr int kBinsOfSide = 16, kPixels = 32000;
  for (const std::uint32_t sample : {0U, 1U, 6U, 1000U}) {
    std::vector<double> bins(kBinsOfSide * kBinsOfSide, 0.0);
    for (int x = 0; x < kPixels; ++x) {
      const glm::vec2 p = sobol_pair(pixel_key(6, x, 1), sample, 2);
      bins[static_cast<std::size_t>(p.x * kBinsOfSide) * kBinsOfSide +
           static_cast<std::size_t>(p.y * kBinsOfSide)] += 1;
    }
    constexpr double kExpected = static_cast<double>(kPixels) / (kBinsOfSide * kBinsOfSide);
    double chi2 = 0;
    for (const double count : bins) chi2 += std::pow(count - kExpected, 2) / kExpected;
    EXPECT_LT(chi2, 255 + 4 * std::sqrt(2 * 255.0)) << sample;  // 255 degrees of freedom
  }
}

// Root of the mean squared error of the mean of n points, over pixels.
template <class Pair, class F>
double error(Pair pair, F f, double exact, std::uint32_t n) {
  constexpr int kPixels = 60;
  double sum = 0;
  for (int x = 0; x < kPixels; ++x) {
    double mean = 0;
    for (std::uint32_t s = 0; s < n; ++s) mean += f(pair(pixel_key(8, x, 0), s, 3U)) / n;
    sum += std::pow(mean - exact, 2) / kPixels;
  }
  return std::sqrt(sum);
}

TEST(Sampler, IntegratesMuchBetterThanIndependentNumbers) {
  const auto product = [](const glm::vec2& p) { return static_cast<double>(p.x) * p.y; };
  const auto disc = [](const glm::vec2& p) { return p.x * p.x + p.y * p.y < 1.0F ? 1.0 : 0.0; };
  const double independent = error(independent_pair, product, 0.25, 1024);
  const double deviation = std::sqrt(1.0 / 9 - 1.0 / 16) / 32;  // of the mean of 1024
  EXPECT_NEAR(independent / deviation, 1.0, 0.35);
  // Of a smooth function the error falls with n^(-3/2), of an edge with n^(-3/4).
  EXPECT_LT(error(sobol_pair, product, 0.25, 1024), independent / 20);
  EXPECT_LT(error(sobol_pair, disc, M_PI / 4, 1024),
            error(independent_pair, disc, M_PI / 4, 1024) / 3);
  const double few = error(sobol_pair, product, 0.25, 64);
  EXPECT_GT(few / error(sobol_pair, product, 0.25, 1024), 0.5 * std::pow(16.0, 1.5));
}

TEST(Sampler, VectorsGiveTheSameNumbersOnEveryInstructionSet) {
  SampleLanes lanes{};
  for (int i = 0; i < shading::kBlockPoints; ++i) {
    lanes.set(i, pixel_key(10, i * 71, 3), static_cast<std::uint32_t>(i * i * 1001),
              static_cast<std::uint32_t>(i % 5 * 7));
  }
  tests::for_each_target([&] {
    Pairs16 pairs[3];
    sobol_pairs(lanes, pairs);
    for (int i = 0; i < shading::kBlockPoints; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const glm::vec2 expected =
            sobol_pair(pixel_key(10, i * 71, 3), lanes.sample[i], lanes.dimension[i] + k);
        ASSERT_EQ(glm::vec2(pairs[k].x[i], pairs[k].y[i]), expected) << i << " " << k;
      }
    }
  });
}

TEST(Sampler, BlocksHaveTheKeysOfTheirPixels) {
  tests::for_each_target([] {
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{0xFEDCBA9876543210U}}) {
      for (const glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(1916, 4), glm::ivec2(8, 1 << 20)}) {
        PixelKeys keys;
        pixel_keys(seed, at.x, at.y, keys);
        for (int i = 0; i < shading::kBlockPoints; ++i) {
          ASSERT_EQ(keys.key(i), pixel_key(seed, at.x + i % 4, at.y + i / 4)) << at.x << " " << i;
        }
      }
    }
  });
}

TEST(Sampler, GoesThroughDimensionsInOrder) {
  const std::uint64_t pixel = pixel_key(9, 10, 11);
  Sampler sampler(pixel, 12, 3);
  EXPECT_EQ(sampler.one(), sobol(pixel, 12, 3));
  EXPECT_EQ(sampler.two(), sobol_pair(pixel, 12, 4));
  sampler.skip(2);
  EXPECT_EQ(sampler.one(), sobol(pixel, 12, 7));
  EXPECT_EQ(sampler.dimension(), 8U);
}

}  // namespace
}  // namespace delray::raytrace
