// A random number generator of a few instructions, for choices that need no better.
#pragma once

#include <cstdint>

namespace delray::delaunay::internal {

// Marsaglia's xorshift (2003) of 32 bits: moves `state` on and returns it. REQUIRES: state != 0.
inline std::uint32_t next_random(std::uint32_t& state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

}  // namespace delray::delaunay::internal
