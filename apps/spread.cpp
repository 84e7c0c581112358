#include "apps/spread.h"

#include <algorithm>

namespace delray::apps {

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size();
  const double median = (values[(count - 1) / 2] + values[count / 2]) / 2;
  return {median, values.front(), values.back(), static_cast<int>(count)};
}

}  // namespace delray::apps
