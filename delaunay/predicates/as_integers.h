// Doubles as integers of any size, for the last stage of predicates.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace delray::delaunay::internal {

using Integer = boost::multiprecision::cpp_int;

// Times a common power of two. REQUIRES: finite values.
template <std::size_t N>
std::array<Integer, N> as_integers(const std::array<double, N>& values) {
  int lowest = 2000;
  for (const double x : values) {
    int exponent = 0;
    if (std::frexp(x, &exponent) != 0) lowest = std::min(lowest, exponent - 53);
  }
  std::array<Integer, N> result;
  for (std::size_t i = 0; i < N; ++i) {
    int exponent = 0;
    const double mantissa = std::frexp(values[i], &exponent);
    result[i] = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    if (mantissa != 0) result[i] <<= exponent - 53 - lowest;
  }
  return result;
}

}  // namespace delray::delaunay::internal
