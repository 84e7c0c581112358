// Medians of repeated runs, and which of them can be told apart.
#include "apps/compare/spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace delray::apps {
namespace {

std::vector<double> one_to(int last) {
  std::vector<double> values(static_cast<std::size_t>(last));
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST(Spread, HoldsTheMedianAndTheIntervalOfItsOrder) {
  struct Case {
    int runs;
    double low, high;
  };
  // From tables of the sign test: runs left out at either end for 95 %.
  for (const Case& one : {Case{2, 1, 2},
                          {3, 1, 3},
                          {5, 1, 5},
                          {6, 1, 6},
                          {8, 1, 8},
                          {9, 2, 8},
                          {12, 3, 10},
                          {15, 4, 12},
                          {20, 6, 15},
                          {30, 10, 21}}) {
    const Spread spread = spread_of(one_to(one.runs));
    EXPECT_EQ(spread.median, (one.runs + 1) / 2.0);
    EXPECT_EQ(spread.least, 1);
    EXPECT_EQ(spread.most, one.runs);
    EXPECT_EQ(spread.low, one.low) << one.runs;
    EXPECT_EQ(spread.high, one.high) << one.runs;
    EXPECT_EQ(spread.runs, one.runs);
  }
}

TEST(Spread, IntervalsHoldTheTrueMedianAsOftenAsTheySay) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> times(1);
  constexpr int kTrials = 4000;
  for (const int runs : {7, 9, 15, 31}) {
    int held = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<double> values;
      for (int i = 0; i < runs; ++i) values.push_back(times(random));
      const Spread spread = spread_of(values);
      held += spread.low <= std::log(2.0) && std::log(2.0) <= spread.high;
    }
    EXPECT_GE(held, kTrials * 0.94) << runs;
  }
}

TEST(Spread, TellsApartWhatDoesNotOverlap) {
  EXPECT_TRUE(differ(spread_of({1, 2, 3}), spread_of({4, 5, 6})));
  EXPECT_TRUE(differ(spread_of({4, 5, 6}), spread_of({1, 2, 3})));
  EXPECT_FALSE(differ(spread_of({1, 2, 4}), spread_of({3, 5, 6})));
  EXPECT_FALSE(differ(spread_of({1, 5, 9}), spread_of({4, 5, 6})));
  EXPECT_FALSE(differ(spread_of({1, 2, 3}), spread_of({3, 4, 5})));
  // One outlier of fifteen runs hides no difference.
  std::vector<double> fast = one_to(15), slow = one_to(15);
  for (double& value : slow) value += 20;
  fast.back() = 1000;
  EXPECT_TRUE(differ(spread_of(fast), spread_of(slow)));
}

TEST(Spread, TakesOneRunForRightButForAFactor) {
  EXPECT_EQ(spread_of({3}).runs, 1);
  EXPECT_FALSE(differ(spread_of({3}), spread_of({3 * kUnknownFactor * 0.99})));
  EXPECT_TRUE(differ(spread_of({3}), spread_of({3 * kUnknownFactor * 1.01})));
  EXPECT_TRUE(differ(known_within(1, 1), known_within(1.01, 1)));
  EXPECT_FALSE(differ(known_within(1, 1.1), known_within(1.09, 1.1)));
}

TEST(Spread, FindsAllThatCannotBeToldFromTheLeast) {
  const std::vector<Spread> spreads = {spread_of({7, 8, 9}), spread_of({2, 4, 5}),
                                       spread_of({1, 3, 4}), spread_of({4, 6, 7}),
                                       spread_of({5, 6, 7})};
  // The last but one overlaps the least, the last only the one before it.
  EXPECT_EQ(least_of(spreads), (std::vector<std::size_t>{2, 1, 3}));
  EXPECT_TRUE(least_of({}).empty());
}

}  // namespace
}  // namespace delray::apps
