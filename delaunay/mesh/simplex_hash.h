// The hash of one simplex, for those who sum up many.
#pragma once

// Calls cost as much as the hash of so few bytes.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "delaunay/triangulation.h"

namespace delray::delaunay::internal {

// The sum of hashes of simplices.
class HashSum {
 public:
  // Rows in any order, as these are sorted.
  template <std::size_t Corners>
  void add(std::array<std::uint64_t, Corners> rows) {
    // Branchless: the outcome is unpredictable.
    const auto order = [&](std::size_t i, std::size_t j) {
      const std::uint64_t differ = (rows[i] ^ rows[j]) & (0 - std::uint64_t{rows[j] < rows[i]});
      rows[i] ^= differ;
      rows[j] ^= differ;
    };
    if constexpr (Corners == 3) {
      order(0, 1);
      order(1, 2);
      order(0, 1);
    } else if constexpr (Corners > 4) {
      std::ranges::sort(rows);
    } else {
      static_assert(Corners == 4);
      order(0, 1);
      order(2, 3);
      order(0, 2);
      order(1, 3);
      order(1, 2);
    }
    const XXH128_hash_t simplex = XXH3_128bits(rows.data(), sizeof rows);
    const std::uint64_t low = sum_.low + simplex.low64;
    sum_.high += simplex.high64 + (low < sum_.low ? 1 : 0);
    sum_.low = low;
  }
  const Hash128& sum() const { return sum_; }

 private:
  Hash128 sum_;
};

}  // namespace delray::delaunay::internal
