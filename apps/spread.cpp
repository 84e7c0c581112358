#include "apps/spread.h"

#include <algorithm>

namespace delray::apps {

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.front(), values.back(),
          static_cast<int>(values.size())};
}

}  // namespace delray::apps
