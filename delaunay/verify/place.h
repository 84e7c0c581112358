// Coordinates as keys of hash tables.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace delray::delaunay::internal {

// -0 equals 0: adding 0 makes it so.
template <int D>
glm::vec<D, double> without_signed_zeros(const glm::vec<D, double>& p) {
  return p + 0.0;
}

inline std::uint64_t mix_bits(std::uint64_t x) {
  // The finalizer of MurmurHash3 (Appleby).
  x = (x ^ x >> 33) * 0xff51afd7ed558ccdULL;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ x >> 33;
}

template <int D>
std::uint64_t bits_of_place(const glm::vec<D, double>& p) {
  std::uint64_t bits = 0;
  for (int k = 0; k < D; ++k) bits = mix_bits(bits ^ std::bit_cast<std::uint64_t>(p[k]));
  return bits;
}

template <int D>
struct PlaceHash {
  std::size_t operator()(const glm::vec<D, double>& p) const { return bits_of_place<D>(p); }
};

}  // namespace delray::delaunay::internal
