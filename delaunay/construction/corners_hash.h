// A hash of a few vertices, for tables of facets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace delray::delaunay::internal {

struct CornersHash {
  template <std::size_t N>
  std::size_t operator()(const std::array<std::uint32_t, N>& corners) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t corner : corners) {
      hash = (hash ^ (hash >> 29) ^ corner) * 0x9e3779b97f4a7c15U;
    }
    return hash ^ (hash >> 32);
  }
};

}  // namespace delray::delaunay::internal
