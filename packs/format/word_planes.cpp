// Differences of neighbours, cut into planes of bytes, then LZ4 (Collet 2011): neighbouring
// vertices are alike, so that the upper planes are nearly all zero, and the lowest ones are copied
// as they are. Reading is bound by memory, since there is nothing in it but sums and moves.
#include "packs/word_planes.h"

#include <lz4.h>

#include <array>
#include <cstring>

namespace delray::packs {
namespace {

// Negative floats descend with their bits: turned around they ascend. Its own inverse.
std::uint32_t ordered(std::uint32_t bits) {
  const auto sign = static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31);
  return bits ^ (sign >> 1);
}

constexpr std::size_t kBlock = 2048;  // values unpacked at a time

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

void read_planes(const char* bytes, std::size_t n, std::size_t stride, std::uint32_t* values) {
  const auto* const plane = reinterpret_cast<const std::uint8_t*>(bytes);
  std::array<std::uint32_t, kBlock> differences;
  std::uint32_t last = 0;
  for (std::size_t first = 0; first < n; first += kBlock) {
    const std::size_t count = n - first < kBlock ? n - first : kBlock;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = first + i;
      const std::uint32_t word = static_cast<std::uint32_t>(plane[at]) |
                                 static_cast<std::uint32_t>(plane[n + at]) << 8 |
                                 static_cast<std::uint32_t>(plane[2 * n + at]) << 16 |
                                 static_cast<std::uint32_t>(plane[3 * n + at]) << 24;
      differences[i] = word >> 1 ^ (0U - (word & 1));
    }
    for (std::size_t i = 0; i < count; ++i) {
      last += differences[i];
      values[(first + i) * stride] = ordered(last);
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
