// Times of repeated runs.
#pragma once

#include <vector>

namespace delray::apps {

struct Spread {
  double median = 0, least = 0, most = 0;
  int runs = 0;
};

// Of an even number of values the median lies between the two in the middle. REQUIRES: at least one
// value.
Spread spread_of(std::vector<double> values);

}  // namespace delray::apps
