// Medians, their intervals, and which of them can be told apart.
#include "apps/compare/spread.h"

#include <algorithm>
#include <cmath>

namespace delray::apps {
namespace {

constexpr double kDoubt = 0.05;

// The number of values outside the median's interval at either end: as many as the median
// has not even that many values below it but with a probability of kDoubt / 2.
std::size_t outside(std::size_t runs) {
  const auto n = static_cast<double>(runs);
  double probability = std::pow(0.5, n), sum = 0;  // of k values below the median
  std::size_t k = 0;
  for (; k < runs; ++k) {
    sum += probability;
    if (sum > kDoubt / 2) break;
    probability *= (n - static_cast<double>(k)) / (static_cast<double>(k) + 1);
  }
  return k > 0 ? k - 1 : 0;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  const double median = (values[(count - 1) / 2] + values[count / 2]) / 2;
  if (count == 1) {
    Spread once = known_within(median);
    once.runs = 1;
    return once;
  }
  const std::size_t ends = outside(count);
  return {median,       values.front(),          values.back(), static_cast<int>(count),
          values[ends], values[count - 1 - ends]};
}

Spread known_within(double value, double factor) {
  const double side = std::sqrt(factor);
  return {value, value, value, 0, value / side, value * side};
}

bool differ(const Spread& a, const Spread& b) { return a.high < b.low || b.high < a.low; }

std::vector<std::size_t> least_of(std::span<const Spread> spreads) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < spreads.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return spreads[a].median < spreads[b].median;
  });
  std::erase_if(order, [&, least = order.empty() ? 0 : order.front()](std::size_t i) {
    return differ(spreads[i], spreads[least]);
  });
  return order;
}

}  // namespace delray::apps
