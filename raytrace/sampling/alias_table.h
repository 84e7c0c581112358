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

  std::size_t size() const { return own_.size(); }

  // A number i with probability(i). Both arguments from [0, 1).
  // REQUIRES: size() > 0.
  std::uint32_t pick(float column, float height) const;

  // How likely i is; all add up to 1. 0 where the weight is 0: then i is never picked.
  float probability(std::uint32_t i) const { return probabilities_[i]; }

  // For vectors. Element i belongs to column i, of which so much is its own number's; the rest is
  // the alias's.
  std::span<const float> own() const { return own_; }
  std::span<const std::uint32_t> aliases() const { return aliases_; }
  std::span<const float> probabilities() const { return probabilities_; }

 private:
  std::vector<float> own_;
  std::vector<std::uint32_t> aliases_;
  std::vector<float> probabilities_;
};

}  // namespace delray::raytrace
