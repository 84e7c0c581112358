// Drawing numbers in proportion to weights in constant time (Walker 1977; Vose 1991).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace delray::raytrace {

class AliasTable {
 public:
  AliasTable() = default;
  // Weights that are negative, infinite or NaN count as 0; if all do, all numbers are equally
  // likely. O(n).
  explicit AliasTable(std::span<const float> weights);

  std::size_t size() const { return columns_.size(); }

  // A number i with probability(i). Both arguments from [0, 1).
  // REQUIRES: size() > 0.
  std::uint32_t pick(float column, float height) const;

  // How likely i is; all add up to 1. 0 where the weight is 0: then i is never picked.
  float probability(std::uint32_t i) const { return columns_[i].probability; }

 private:
  struct Column {
    float own = 1.0F;  // part of the column that is its own number's; the rest is the alias's
    std::uint32_t alias = 0;
    float probability = 0.0F;
  };
  std::vector<Column> columns_;
};

}  // namespace delray::raytrace
