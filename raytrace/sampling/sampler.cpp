// Random numbers by hashing: keys of pixels by Philox (Salmon et al. 2011), samples shuffled and
// scrambled by operations on reversed bits (Laine and Karras 2011; Burley 2020), one at a time and
// sixteen at a time with the same bits.
//
// The second dimension of Sobol's sequence is a product with Pascal's triangle modulo 2, five
// shifts instead of a matrix. O(1) a number, without state.
#include "raytrace/sampling/sampler.h"

#include <Random123/philox.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/sampling/sampler.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

// The functions of the same names below, over lanes.
using WordTag = hn::RebindToUnsigned<FloatTag>;
using W = hn::Vec<WordTag>;

HWY_INLINE W word(std::uint32_t x) { return hn::Set(WordTag(), x); }

HWY_INLINE W reversed(W x) {
  x = hn::Or(hn::ShiftLeft<16>(x), hn::ShiftRight<16>(x));
  x = hn::Or(hn::ShiftLeft<8>(x & word(0x00FF00FFU)), hn::ShiftRight<8>(x) & word(0x00FF00FFU));
  x = hn::Or(hn::ShiftLeft<4>(x & word(0x0F0F0F0FU)), hn::ShiftRight<4>(x) & word(0x0F0F0F0FU));
  x = hn::Or(hn::ShiftLeft<2>(x & word(0x33333333U)), hn::ShiftRight<2>(x) & word(0x33333333U));
  return hn::Or(hn::ShiftLeft<1>(x & word(0x55555555U)), hn::ShiftRight<1>(x) & word(0x55555555U));
}

HWY_INLINE W scrambled(W digits, W seed) {
  digits = digits ^ digits * word(0x3D20ADEAU);
  digits = digits + seed;
  digits = digits * (hn::ShiftRight<16>(seed) | word(1));
  digits = digits ^ digits * word(0x05526C56U);
  return digits ^ digits * word(0x53A22864U);
}

HWY_INLINE W second_dimension(W number) {
  number = number ^ hn::ShiftRight<16>(number);
  number = number ^ hn::ShiftRight<8>(number & word(0xFF00FF00U));
  number = number ^ hn::ShiftRight<4>(number & word(0xF0F0F0F0U));
  number = number ^ hn::ShiftRight<2>(number & word(0xCCCCCCCCU));
  return number ^ hn::ShiftRight<1>(number & word(0xAAAAAAAAU));
}

HWY_INLINE W mixed(W x) {
  x = (x ^ hn::ShiftRight<16>(x)) * word(0x21F0AAADU);
  x = (x ^ hn::ShiftRight<15>(x)) * word(0xD35A2D97U);
  return x ^ hn::ShiftRight<15>(x);
}

HWY_INLINE F unit(W x) {
  const auto number = hn::BitCast(IntTag(), hn::ShiftRight<8>(x));
  return to_float(number) * set(0x1p-24F);
}

struct Product {
  W low, high;
};

HWY_INLINE Product product(W x, std::uint32_t by) {
  const WordTag d;
#if HWY_TARGET == HWY_SCALAR
  const std::uint64_t both = std::uint64_t{hn::GetLane(x)} * by;
  return {hn::Set(d, static_cast<std::uint32_t>(both)),
          hn::Set(d, static_cast<std::uint32_t>(both >> 32))};
#else
  const hn::RepartitionToWide<WordTag> wide;
  const auto even = hn::MulEven(x, word(by));
  const auto odd = hn::MulEven(hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(wide, x))), word(by));
  return {hn::OddEven(hn::BitCast(d, hn::ShiftLeft<32>(odd)), hn::BitCast(d, even)),
          hn::OddEven(hn::BitCast(d, odd), hn::BitCast(d, hn::ShiftRight<32>(even)))};
#endif
}

// Philox4x32 of ten rounds; the first two of its four words.
void keys_block(std::uint64_t seed, int x, int y, PixelKeys& keys) {
  const WordTag tag;
  HWY_ALIGN static constexpr std::uint32_t kColumns[shading::kBlockPoints] = {
      0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  HWY_ALIGN static constexpr std::uint32_t kRows[shading::kBlockPoints] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                                           2, 2, 2, 2, 3, 3, 3, 3};
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    W a = word(static_cast<std::uint32_t>(x)) + hn::Load(tag, kColumns + i);
    W b = word(static_cast<std::uint32_t>(y)) + hn::Load(tag, kRows + i);
    W c = word(0), d = word(0);
    auto low = static_cast<std::uint32_t>(seed), high = static_cast<std::uint32_t>(seed >> 32);
    for (int round = 0; round < 10; ++round) {
      const Product p = product(a, 0xD2511F53U), q = product(c, 0xCD9E8D57U);
      a = q.high ^ b ^ word(low);
      b = q.low;
      c = p.high ^ d ^ word(high);
      d = p.low;
      low += 0x9E3779B9U;
      high += 0xBB67AE85U;
    }
    hn::Store(a, tag, keys.low + i);
    hn::Store(b, tag, keys.high + i);
  }
}

void pairs_block(const SampleLanes& from, std::span<Pairs16> pairs) {
  const WordTag d;
  for (int i = 0; i < shading::kBlockPoints; i += lanes()) {
    const W low = hn::Load(d, from.key_low + i), high = hn::Load(d, from.key_high + i);
    const W sample = reversed(hn::Load(d, from.sample + i));
    W step = hn::Load(d, from.dimension + i) * word(0x9E3779B9U);
    for (Pairs16& pair : pairs) {
      const W order = mixed(high ^ mixed(low + step));
      step = step + word(0x9E3779B9U);
      const W number = reversed(scrambled(sample, order));
      const W x = scrambled(number, mixed(order + low));
      const W y = scrambled(second_dimension(number), mixed(order + high));
      hn::Store(unit(reversed(x)), FloatTag(), pair.x.lane + i);
      hn::Store(unit(reversed(y)), FloatTag(), pair.y.lane + i);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(keys_block);
HWY_EXPORT(pairs_block);

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

// A permutation of all words in which every bit of the result depends on every bit of x (constants:
// C. Wellons, "Hash Prospector", 2018).
std::uint32_t mixed(std::uint32_t x) {
  x = (x ^ x >> 16) * 0x21F0AAADU;
  x = (x ^ x >> 15) * 0xD35A2D97U;
  return x ^ x >> 15;
}

std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

// The order of a pixel's samples in a dimension; keys of their scramblings derive from it.
std::uint32_t order_of(std::uint64_t pixel, std::uint32_t dimension) {
  return mixed(high(pixel) ^ mixed(low(pixel) + dimension * 0x9E3779B9U));
}

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

void pixel_keys(std::uint64_t seed, int x, int y, PixelKeys& keys) {
  HWY_DYNAMIC_DISPATCH(keys_block)(seed, x, y, keys);
}

float sobol(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  // Other keys than a pair's.
  const std::uint32_t order = order_of(~pixel, dimension);
  return unit(reversed(scrambled(shuffled(sample, order), mixed(order + low(pixel)))));
}

glm::vec2 sobol_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  const std::uint32_t order = order_of(pixel, dimension);
  const std::uint32_t number = shuffled(sample, order);
  return {unit(reversed(scrambled(number, mixed(order + low(pixel))))),
          unit(reversed(scrambled(second_dimension(number), mixed(order + high(pixel)))))};
}

void sobol_pairs(const SampleLanes& lanes, std::span<Pairs16> pairs) {
  HWY_DYNAMIC_DISPATCH(pairs_block)(lanes, pairs);
}

glm::vec2 independent_pair(std::uint64_t pixel, std::uint32_t sample, std::uint32_t dimension) {
  const r123::Philox4x32::ctr_type block =
      r123::Philox4x32()({{sample, dimension, 0, 1}}, {{low(pixel), high(pixel)}});
  return {unit(block[0]), unit(block[1])};
}

}  // namespace delray::raytrace
#endif
