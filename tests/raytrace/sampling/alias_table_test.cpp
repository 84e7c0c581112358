#include "raytrace/sampling/alias_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace delray::raytrace {
namespace {

// How often each number is picked from a fine grid over both arguments.
std::vector<double> shares(const AliasTable& table) {
  const int columns = static_cast<int>(table.size()) * 4;
  constexpr int kRows = 512;
  std::vector<double> found(table.size(), 0.0);
  for (int x = 0; x < columns; ++x) {
    for (int y = 0; y < kRows; ++y) {
      const float u = (static_cast<float>(x) + 0.5F) / static_cast<float>(columns);
      found.at(table.pick(u, (static_cast<float>(y) + 0.5F) / kRows)) += 1.0 / columns / kRows;
    }
  }
  return found;
}

TEST(AliasTable, PicksInProportionToWeights) {
  std::mt19937 random(1);
  std::exponential_distribution<float> weight;
  for (const std::size_t n : {1U, 2U, 3U, 17U, 200U}) {
    std::vector<float> weights(n);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      sum += weights[i] = i % 5 == 4 ? 0.0F : weight(random) * (i % 7 == 0 ? 100.0F : 1.0F);
    const AliasTable table(weights);
    const std::vector<double> found = shares(table);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(table.probability(static_cast<std::uint32_t>(i)), weights[i] / sum, 1e-6);
      EXPECT_NEAR(found[i], weights[i] / sum, 0.003) << "seed 1, " << i << " of " << n;
      if (weights[i] == 0.0F) {
        EXPECT_EQ(found[i], 0.0);
      }
    }
  }
}

TEST(AliasTable, WeightsThatAreNoneAreNeverPicked) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<float> weights = {nan, 1.0F, -2.0F, infinite, 3.0F};
  const std::vector<double> found = shares(AliasTable(weights));
  EXPECT_EQ(found[0] + found[2] + found[3], 0.0);
  EXPECT_NEAR(found[1], 0.25, 0.003);
}

TEST(AliasTable, WithoutAnyWeightAllAreEquallyLikely) {
  const std::vector<double> found = shares(AliasTable(std::vector<float>(4, 0.0F)));
  for (const double share : found) EXPECT_NEAR(share, 0.25, 1e-9);
  EXPECT_EQ(AliasTable(std::vector<float>{}).size(), 0U);
}

TEST(AliasTable, TheEndsOfTheRangesAreInside) {
  const AliasTable table(std::vector<float>{1.0F, 2.0F, 5.0F});
  const float last = 1.0F - 0x1p-24F;
  EXPECT_LT(table.pick(last, last), 3U);
  EXPECT_LT(table.pick(0.0F, 0.0F), 3U);
}

}  // namespace
}  // namespace delray::raytrace
