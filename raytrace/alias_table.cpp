#include "raytrace/alias_table.h"

#include <algorithm>
#include <cmath>

namespace delray::raytrace {

AliasTable::AliasTable(std::span<const float> weights) : columns_(weights.size()) {
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
    columns_[i].probability = static_cast<float>(rest[i] / static_cast<double>(n));
    columns_[i].alias = static_cast<std::uint32_t>(i);
    (rest[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t to = small.back(), from = large.back();
    small.pop_back();
    columns_[to].own = static_cast<float>(rest[to]);
    columns_[to].alias = from;
    rest[from] -= 1.0 - rest[to];
    if (rest[from] >= 1.0) continue;
    large.pop_back();
    small.push_back(from);
  }
  // What is left differs from 1 by roundings, unless its weight is 0 and nothing was left for it.
  for (const std::uint32_t i : small) {
    if (columns_[i].probability > 0.0F) continue;
    columns_[i].own = 0.0F;
    const auto most = std::max_element(columns_.begin(), columns_.end(), [](auto& a, auto& b) {
      return a.probability < b.probability;
    });
    columns_[i].alias = static_cast<std::uint32_t>(most - columns_.begin());
  }
}

std::uint32_t AliasTable::pick(float column, float height) const {
  const auto n = columns_.size();
  const auto i = std::min(
      static_cast<std::size_t>(static_cast<double>(column) * static_cast<double>(n)), n - 1);
  return height < columns_[i].own ? static_cast<std::uint32_t>(i) : columns_[i].alias;
}

}  // namespace delray::raytrace
