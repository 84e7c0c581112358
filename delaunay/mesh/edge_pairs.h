// The edges of a closed surface of triangles, each of which two of them share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace delray::delaunay::internal {

// Collects edges by their ends, with a value for each use, and pairs the two uses of each.
template <class Value>
class EdgePairs {
 public:
  explicit EdgePairs(std::size_t uses) { uses_.reserve(uses); }

  void add(std::uint32_t a, std::uint32_t b, Value value) {
    const auto [low, high] = std::minmax(a, b);
    uses_.push_back({std::uint64_t{low} << 32 | high, value});
  }
  // Calls f(value, value) for the two uses of each edge, by ascending ends. O(n log n).
  // REQUIRES: each edge was added twice.
  template <class F>
  void for_each(F&& f) {
    std::ranges::sort(uses_, {}, &Use::ends);
    for (std::size_t i = 0; i + 1 < uses_.size(); i += 2) f(uses_[i].value, uses_[i + 1].value);
  }

 private:
  struct Use {
    std::uint64_t ends;  // the lower one in the upper half
    Value value;
  };
  std::vector<Use> uses_;
};

}  // namespace delray::delaunay::internal
