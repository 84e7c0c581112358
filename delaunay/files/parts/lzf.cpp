// Reads one control byte after the other: below 32 it is followed by that many literal bytes and
// one more; else its upper three bits are the length of a copy, its lower five and the next byte
// the distance.
#include "delaunay/files/parts/lzf.h"

#include <cstring>

namespace delray::delaunay {

bool unpack_lzf(std::string_view packed, std::span<char> unpacked) {
  constexpr unsigned kLiterals = 32, kLongLength = 7;
  std::size_t from = 0, to = 0;
  const auto next = [&] { return static_cast<unsigned char>(packed[from++]); };
  while (from < packed.size()) {
    const unsigned control = next();
    if (control < kLiterals) {
      const std::size_t length = control + 1;
      if (length > packed.size() - from || length > unpacked.size() - to) return false;
      std::memcpy(unpacked.data() + to, packed.data() + from, length);
      from += length;
      to += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (packed.size() - from < (length == kLongLength ? 2U : 1U)) return false;
    if (length == kLongLength) length += next();
    length += 2;
    const std::size_t distance = ((control & 31U) << 8 | next()) + 1;
    if (distance > to || length > unpacked.size() - to) return false;
    // Byte by byte: a copy may begin within itself.
    for (std::size_t i = 0; i < length; ++i, ++to) unpacked[to] = unpacked[to - distance];
  }
  return to == unpacked.size();
}

}  // namespace delray::delaunay
