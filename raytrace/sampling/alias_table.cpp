// Builds the table with two stacks (Vose 1991): columns below the mean are filled up from one above
// it. O(n) to build, O(1) to draw.
//
// Degenerate: weights that do not count become 0; where all are 0 all numbers are equally likely; a
// column without a share of its own draws the likeliest number.
#include "raytrace/sampling/alias_table.h"

#include <algorithm>
#include <cmath>

namespace delray::raytrace {

AliasTable::AliasTable(std::span<const float> weights)
    : own_(weights.size(), 1.0F), aliases_(weights.size()), probabilities_(weights.size()) {
  const std::size_t n = weights.size();
  std::vector<double> rest(n);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    rest[i] = std::isfinite(weights[i]) ? std::max(0.0, static_cast<double>(weights[i])) : 0.0;
    sum += rest[i];
  }
  if (!(sum > 0.0)) {
    std::fill(rest.begin(), rest.end(), 1.0);
    sum = static_cast<double>(n);
  }
  // Each column holds 1; those with less than that are filled up from those with more.
  std::vector<std::uint32_t> small, large;
  for (std::size_t i = 0; i < n; ++i) {
    rest[i] *= static_cast<double>(n) / sum;
    probabilities_[i] = static_cast<float>(rest[i] / static_cast<double>(n));
    aliases_[i] = static_cast<std::uint32_t>(i);
    (rest[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t to = small.back(), from = large.back();
    small.pop_back();
    own_[to] = static_cast<float>(rest[to]);
    aliases_[to] = from;
    rest[from] -= 1.0 - rest[to];
    if (rest[from] >= 1.0) continue;
    large.pop_back();
    small.push_back(from);
  }
  // The probabilities that are left differ from 1 by roundings, unless its weight is 0 and nothing
  // was left for it.
  for (const std::uint32_t i : small) {
    if (probabilities_[i] > 0.0F) continue;
    own_[i] = 0.0F;
    const auto most = std::max_element(probabilities_.begin(), probabilities_.end());
    aliases_[i] = static_cast<std::uint32_t>(most - probabilities_.begin());
  }
}

std::uint32_t AliasTable::pick(float column, float height) const {
  const auto n = own_.size();
  const auto i = std::min(
      static_cast<std::size_t>(static_cast<double>(column) * static_cast<double>(n)), n - 1);
  return height < own_[i] ? static_cast<std::uint32_t>(i) : aliases_[i];
}

}  // namespace delray::raytrace
