#include "raytrace/sampler.h"

#include <Random123/philox.h>

namespace delray::raytrace {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x & 0x0F0F0F0FU) << 4 | (x >> 4 & 0x0F0F0F0FU);
  x = (x & 0x33333333U) << 2 | (x >> 2 & 0x33333333U);
  return (x & 0x55555555U) << 1 | (x >> 1 & 0x55555555U);
}

// A nested uniform scrambling of digits that are stored backwards, the first one lowest: every
// operation lets a bit depend on itself and on bits below it alone. Products by even numbers are
// what makes bits depend on those below (Laine and Karras 2011), by odd ones what makes the
// dependence another for another seed (constants: N. Vegdahl, "Building a Better LK Hash", 2021).
std::uint32_t scrambled(std::uint32_t digits, std::uint32_t seed) {
  digits ^= digits * 0x3D20ADEAU;
  digits += seed;
  digits *= (seed >> 16) | 1U;
  digits ^= digits * 0x05526C56U;
  digits ^= digits * 0x53A22864U;
  return digits;
}

// Digits, backwards, of the second dimension of Sobol's sequence: the number's bits times Pascal's
// triangle modulo 2, which is a Kronecker power of a 2 x 2 matrix.
std::uint32_t second_dimension(std::uint32_t number) {
  number ^= number >> 16;
  number ^= (number & 0xFF00FF00U) >> 8;
  number ^= (number & 0xF0F0F0F0U) >> 4;
  number ^= (number & 0xCCCCCCCCU) >> 2;
  return number ^ (number & 0xAAAAAAAAU) >> 1;
}

// The output function of SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27) * 0x94D049BB133111EBU;
  return x ^ x >> 31;
}

// Two keys for every dimension.
std::uint64_t dimension_key(std::uint64_t pixel, std::uint32_t dimension, std::uint64_t which) {
  return mixed(pixel + (2 * std::uint64_t{dimension} + which + 1) * 0x9E3779B97F4A7C15U);
}

std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

// Samples in another order, in which aligned 2^k of them stay together.
std::uint32_t shuffled(std::uint32_t sample, std::uint32_t seed) {
  return reversed(scrambled(reversed(sample), seed));
}

float unit(std::uint32_t x) { return static_cast<float>(x >> 8) * 0x1p-24F; }

}  // namespace

std::uint64_t pixel_key(std::uint64_t seed, int x, int y) {
  const r123::Philox4x32::ctr_type block =
      r123::Philox4x32()({{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0}},
                         {{low(seed), high(seed)}});
  return std::uint64_t{block[1]} << 32 | block[0];
}

float sobol(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  const std::uint64_t key = dimension_key(pixel, dimension, 0);
  // Another start of the scrambling than a pair's.
  return unit(reversed(scrambled(shuffled(sample, high(key)), low(key))));
}

glm::vec2 sobol_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  const std::uint64_t order = dimension_key(pixel, dimension, 0);
  const std::uint64_t keys = dimension_key(pixel, dimension, 1);
  const std::uint32_t number = shuffled(sample, low(order));
  return {unit(reversed(scrambled(number, low(keys)))),
          unit(reversed(scrambled(second_dimension(number), high(keys))))};
}

glm::vec2 independent_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  const r123::Philox4x32::ctr_type block =
      r123::Philox4x32()({{sample, dimension, 0, 1}}, {{low(pixel), high(pixel)}});
  return {unit(block[0]), unit(block[1])};
}

}  // namespace delray::raytrace
