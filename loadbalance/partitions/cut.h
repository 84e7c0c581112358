// Choosing the border at which a stretch of columns or rows is cut in two.
#pragma once

#include <algorithm>
#include <cmath>

namespace delray::loadbalance::internal {

// The number of parts on the first side of a cut: half; of an odd number the larger half at
// even depths of the recursion, the smaller at odd ones (Mueller 1995).
inline int first_half(int parts, int depth) { return depth % 2 == 0 ? (parts + 1) / 2 : parts / 2; }

// The border strictly between `low` and `high` where the cost before it is nearest to the share of
// `first_parts` of the parts, of two equally near ones the first; by length where there is no cost.
// O(log(high - low)) calls. REQUIRES: high - low >= 2; cost_before(border), the cost between low
// and the border, does not decrease.
template <class CostBefore>
int cut_at_share(int low, int high, int first_parts, int parts, CostBefore&& cost_before) {
  const double total = cost_before(high);
  if (!(total > 0)) {
    const double position = static_cast<double>(high - low) * first_parts / parts;
    return std::clamp(low + static_cast<int>(position + 0.5), low + 1, high - 1);
  }
  const double wanted = total * first_parts / parts;
  int first = low + 1, last = high - 1;  // the first border that reaches it, or high - 1
  while (first < last) {
    const int middle = first + (last - first) / 2;
    if (cost_before(middle) < wanted) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  if (first == low + 1) return first;
  const double above = std::abs(cost_before(first) - wanted);
  const double below = std::abs(wanted - cost_before(first - 1));
  return above < below ? first : first - 1;
}

}  // namespace delray::loadbalance::internal
