// Longest processing time first (Graham 1969).
#pragma once

#include <span>
#include <vector>

namespace delray::loadbalance::internal {

// Which of `ranks` ranks gets item i: the items by descending load, each to the rank that has
// least so far. Equal loads in the order of their numbers, equal ranks by the lowest.
std::vector<int> largest_first(std::span<const double> loads, int ranks);

}  // namespace delray::loadbalance::internal
