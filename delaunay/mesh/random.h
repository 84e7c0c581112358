// Random numbers that are a function of a seed, a row and a draw.
#pragma once

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>

namespace delray::delaunay {

// The random numbers of one row, one after the other.
class RowRandom {
 public:
  RowRandom(std::uint64_t seed, std::uint64_t row)
      : key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}},
        counter_{{static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(row >> 32), 0, 0}} {}

  std::uint64_t bits() {
    if (unused_ == 0) {
      block_ = r123::Philox4x32()(counter_, key_);
      ++counter_[2];
      unused_ = 2;
    }
    --unused_;
    return std::uint64_t{block_[2 * unused_]} << 32 | block_[2 * unused_ + 1];
  }

  // A multiple of 2^-53 from [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // From [0, n). The bias is below n / 2^53.
  std::uint64_t below(std::uint64_t n) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(n));
  }
  // Mean 0, deviation 1, by the polar method (Marsaglia and Bray 1964).
  double normal();

 private:
  r123::Philox4x32::key_type key_;
  r123::Philox4x32::ctr_type counter_;
  r123::Philox4x32::ctr_type block_{};
  int unused_ = 0;  // of the two numbers in block_
};

// The natural logarithm of a positive normal number to about 1e-16, from additions, multiplications
// and divisions only: libm's differs between machines in the last bit.
inline double portable_log(double x) {
  int exponent = 0;
  double fraction = std::frexp(x, &exponent);  // from [1/2, 1); exact
  if (fraction < 0.70710678118654752) {
    fraction *= 2;
    --exponent;
  }
  // log f = 2 artanh(t), |t| < 0.172: fifteen terms of the series leave 0.172^31 / 31.
  const double t = (fraction - 1) / (fraction + 1), square = t * t;
  double series = 0;
  for (int term = 29; term >= 1; term -= 2) series = series * square + 1.0 / term;
  return 2 * t * series + exponent * 0.69314718055994531;
}

inline double RowRandom::normal() {
  while (true) {
    const double u = uniform(-1, 1), v = uniform(-1, 1), square = u * u + v * v;
    if (square > 0 && square < 1) return u * std::sqrt(-2 * portable_log(square) / square);
  }
}

}  // namespace delray::delaunay
