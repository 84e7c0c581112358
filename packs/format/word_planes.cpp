// Differences of neighbours, cut into planes of bytes, then LZ4 (Collet 2011): neighbouring
// vertices are alike, so that the upper planes are nearly all zero, and the lowest ones are copied
// as they are. Reading puts the bytes together and sums the differences up by vectors.
#include "packs/word_planes.h"

#include <lz4.h>

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "packs/format/word_planes.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::packs {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Words = HWY_CAPPED(std::uint32_t, 16);
using W = hn::Vec<Words>;

// Lane i of the result is the sum of lanes 0 to i.
HWY_INLINE W sums(Words d, W v) {
  const W lane = hn::Iota(d, 0);
  for (std::uint32_t by = 1; by < hn::Lanes(d); by *= 2) {
    const auto has_one = hn::Gt(lane, hn::Set(d, by - 1));
    const W from = hn::IfThenElseZero(has_one, hn::Sub(lane, hn::Set(d, by)));
    const W shifted = hn::TableLookupLanes(v, hn::IndicesFromVec(d, from));
    v = hn::Add(v, hn::IfThenElseZero(has_one, shifted));
  }
  return v;
}

// The values i to i + lanes of planes of n bytes, of which those before sum up to `last`.
HWY_INLINE W next_values(Words d, const std::uint8_t* plane, std::size_t n, std::size_t i,
                         W& last) {
  const hn::Rebind<std::uint8_t, Words> d8;
  const auto load = [&](std::size_t k) {
    return hn::PromoteTo(d, hn::LoadU(d8, plane + k * n + i));
  };
  const W low = hn::Or(load(0), hn::ShiftLeft<8>(load(1)));
  const W word = hn::Or(low, hn::Or(hn::ShiftLeft<16>(load(2)), hn::ShiftLeft<24>(load(3))));
  const W negative = hn::Sub(hn::Zero(d), hn::And(word, hn::Set(d, 1)));
  const W value = hn::Add(last, sums(d, hn::Xor(hn::ShiftRight<1>(word), negative)));
  const W end = hn::Set(d, static_cast<std::uint32_t>(hn::Lanes(d) - 1));
  last = hn::TableLookupLanes(value, hn::IndicesFromVec(d, end));
  const hn::RebindToSigned<Words> di;
  const W sign = hn::BitCast(d, hn::ShiftRight<31>(hn::BitCast(di, value)));
  return hn::Xor(value, hn::ShiftRight<1>(sign));
}

// Whole vectors of values. Returns how many are read.
template <int K>
std::size_t read_most(const std::uint8_t* planes, std::size_t n, std::uint32_t* values,
                      std::uint32_t* last_values) {
  const Words d;
  const std::size_t lanes = hn::Lanes(d);
  W last[K];
  for (W& sum : last) sum = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    W v[K];
    for (std::size_t k = 0; k < K; ++k) v[k] = next_values(d, planes + 4 * k * n, n, i, last[k]);
    std::uint32_t* const to = values + K * i;
    if constexpr (K == 1) hn::StoreU(v[0], d, to);
    if constexpr (K == 2) hn::StoreInterleaved2(v[0], v[1], d, to);
    if constexpr (K == 3) hn::StoreInterleaved3(v[0], v[1], v[2], d, to);
    if constexpr (K == 4) hn::StoreInterleaved4(v[0], v[1], v[2], v[3], d, to);
  }
  for (std::size_t k = 0; k < K; ++k) last_values[k] = hn::GetLane(last[k]);
  return i;
}

std::size_t read_vectors(const std::uint8_t* planes, std::size_t n, int k, std::uint32_t* values,
                         std::uint32_t* last) {
  switch (k) {
    case 1:
      return read_most<1>(planes, n, values, last);
    case 2:
      return read_most<2>(planes, n, values, last);
    case 3:
      return read_most<3>(planes, n, values, last);
    default:
      return read_most<4>(planes, n, values, last);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::packs
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::packs {
namespace {

HWY_EXPORT(read_vectors);

// Negative floats descend with their bits: turned around they ascend. Its own inverse.
std::uint32_t ordered(std::uint32_t bits) {
  const auto sign = static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31);
  return bits ^ (sign >> 1);
}

}  // namespace

void append_planes(const std::uint32_t* values, std::size_t n, std::size_t stride,
                   std::vector<char>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + 4 * n);
  char* const plane = bytes.data() + begin;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t value = ordered(values[i * stride]);
    const std::uint32_t difference = value - last;
    last = value;
    const std::uint32_t word =
        difference << 1 ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(difference) >> 31);
    for (std::size_t k = 0; k < 4; ++k) plane[k * n + i] = static_cast<char>(word >> (8 * k));
  }
}

void read_planes(const char* bytes, std::size_t n, int k, std::uint32_t* values) {
  const auto* const planes = reinterpret_cast<const std::uint8_t*>(bytes);
  const auto width = static_cast<std::size_t>(k);
  std::uint32_t last[4] = {};
  const std::size_t read = HWY_DYNAMIC_DISPATCH(read_vectors)(planes, n, k, values, last);
  for (std::size_t j = 0; j < width; ++j) {
    const std::uint8_t* const plane = planes + 4 * j * n;
    for (std::size_t i = read; i < n; ++i) {
      const std::uint32_t word = static_cast<std::uint32_t>(plane[i]) |
                                 static_cast<std::uint32_t>(plane[n + i]) << 8 |
                                 static_cast<std::uint32_t>(plane[2 * n + i]) << 16 |
                                 static_cast<std::uint32_t>(plane[3 * n + i]) << 24;
      last[j] += word >> 1 ^ (0U - (word & 1));
      values[i * width + j] = ordered(last[j]);
    }
  }
}

std::vector<char> compress(std::span<const char> bytes) {
  std::vector<char> result(bytes.size());
  const int size = bytes.empty() ? 0
                                 : LZ4_compress_default(bytes.data(), result.data(),
                                                        static_cast<int>(bytes.size()),
                                                        static_cast<int>(result.size() - 1));
  if (size > 0) {
    result.resize(static_cast<std::size_t>(size));
  } else if (!bytes.empty()) {
    std::memcpy(result.data(), bytes.data(), bytes.size());
  }
  return result;
}

bool decompress(std::span<const char> compressed, std::span<char> bytes) {
  if (compressed.size() == bytes.size()) {
    if (!bytes.empty()) std::memcpy(bytes.data(), compressed.data(), bytes.size());
    return true;
  }
  if (compressed.size() > bytes.size()) return false;
  return LZ4_decompress_safe(compressed.data(), bytes.data(), static_cast<int>(compressed.size()),
                             static_cast<int>(bytes.size())) == static_cast<int>(bytes.size());
}

}  // namespace delray::packs
#endif  // HWY_ONCE
