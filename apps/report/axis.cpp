// Finds the range of an axis and its ticks. Degenerate: a single value gets a range around it;
// values that are not finite, or not positive on a logarithmic axis, do not count.
#include "apps/report/axis.h"

#include <algorithm>
#include <cmath>

#include "apps/report/html.h"

namespace delray::apps::report {

Axis::Axis(std::span<const double> values, Scale scale)
    : scale_(scale),
      low_(scale == Scale::linear ? 0 : std::nan("")),
      high_(scale == Scale::linear ? 0 : std::nan("")) {
  for (const double value : values) {
    if (!std::isfinite(value) || (scale == Scale::logarithmic && !(value > 0))) continue;
    low_ = std::fmin(low_, value);
    high_ = std::fmax(high_, value);
  }
  if (scale == Scale::linear) {
    if (!(high_ > low_)) high_ = low_ + 1;
    return;
  }
  if (std::isnan(low_)) low_ = 1, high_ = 10;
  // Single values lie in the middle of a decade.
  if (!(high_ > low_)) low_ /= std::sqrt(10.0), high_ *= std::sqrt(10.0);
}

double Axis::position(double value) const {
  if (scale_ == Scale::linear) return (value - low_) / (high_ - low_);
  return std::log(value / low_) / std::log(high_ / low_);
}

std::vector<Tick> Axis::ticks() const {
  std::vector<Tick> result;
  const auto add = [&](double value) { result.push_back({value, short_number(value)}); };
  if (scale_ == Scale::linear) {
    const double rough = (high_ - low_) / 5;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double factor = rough / power;
    const double step = power * (factor < 1.5 ? 1 : factor < 3.5 ? 2 : factor < 7.5 ? 5 : 10);
    const double first = std::ceil(low_ / step);
    for (int i = 0; (first + i) * step <= high_ * (1 + 1e-9); ++i) add((first + i) * step);
    return result;
  }
  const double decades = std::log10(high_ / low_);
  const int first = static_cast<int>(std::floor(std::log10(low_)));
  const int last = static_cast<int>(std::ceil(std::log10(high_)));
  const int stride = std::max(1, static_cast<int>(decades / 7));
  const auto add_powers = [&](std::initializer_list<double> factors) {
    result.clear();
    for (int power = first; power <= last; power += stride) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, power);
        if (value >= low_ * (1 - 1e-9) && value <= high_ * (1 + 1e-9)) add(value);
      }
    }
  };
  if (decades > 3)
    add_powers({1});
  else
    add_powers({1, 2, 5});
  if (result.size() < 3) add_powers({1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8});
  if (result.size() < 2) {
    result.clear();
    add(low_), add(high_);
  }
  return result;
}

std::vector<Tick> Axis::ticks_at(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<Tick> result;
  result.reserve(sorted.size());
  for (const double value : sorted) result.push_back({value, short_number(value)});
  return result;
}

}  // namespace delray::apps::report
