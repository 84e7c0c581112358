// Random numbers, noise and turns that are the same on every machine: integers, and floating point
// by + - * / and sqrt only, which IEEE 754 defines to the last bit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace delray::scenes::internal {

// A bijection of 64-bit integers that scatters them (the finaliser of SplitMix64, Steele et al.
// 2014).
constexpr std::uint64_t scatter(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

// A stream of random numbers for each seed and stream number.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : key_(scatter(seed ^ scatter(stream))) {}

  std::uint64_t bits() { return scatter(key_ + 0xD1B54A32D192ED03U * ++count_); }
  float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24F; }  // [0, 1)
  float between(float low, float high) { return low + (high - low) * unit(); }
  std::uint32_t below(std::uint32_t n) {  // 0 .. n - 1; REQUIRES: n >= 1
    return static_cast<std::uint32_t>(((bits() >> 32) * n) >> 32);
  }

 private:
  std::uint64_t key_, count_ = 0;
};

struct NoiseSample {
  float value;         // about -1 to 1
  glm::vec3 gradient;  // its derivative by x, y and z
};

// Gradient noise over the integer lattice with quintic interpolation (Perlin 2002), twice
// differentiable. Coordinates: |x| < 2^30.
NoiseSample noise(std::uint64_t seed, const glm::vec3& p);

// Noise in the plane; z of the gradient is 0. Half the cost.
NoiseSample noise(std::uint64_t seed, const glm::vec2& p);

// (cos, sin) of 2 pi `turns`, to 1e-9.
glm::dvec2 turn(double turns);

}  // namespace delray::scenes::internal
