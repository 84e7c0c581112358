// Times of repeated runs, and which of them can be told apart.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace delray::apps {

// The median of repeated runs. It lies in [low, high] with 95 %: between two of the runs, the same
// number of places from either end of their order, which follows from the binomial distribution
// alone. Of fewer than six runs that is all of their spread, which is less certain.
struct Spread {
  double median = 0, least = 0, most = 0;
  int runs = 0;
  double low = 0, high = 0;
};

// One run tells nothing of the spread, nor does a prediction: they are taken to be right but for
// this factor, unless more is known.
inline constexpr double kUnknownFactor = 1.5;

// The median of an even number of values lies between the two in the middle. REQUIRES: at least one
// value.
Spread spread_of(std::vector<double> values);

// A value of which another can be told apart that is more than `factor` times as much. REQUIRES:
// factor >= 1.
Spread known_within(double value, double factor = kUnknownFactor);

// Whether two medians can be told apart: their intervals do not overlap. All that reports say of
// what is fastest, or as fast, goes by it.
bool differ(const Spread& a, const Spread& b);

// Indices of those that cannot be told from the least median: that one first, the others by
// ascending medians. Empty of none. O(n log n).
std::vector<std::size_t> least_of(std::span<const Spread> spreads);

}  // namespace delray::apps
