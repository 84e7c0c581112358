// Packs bytes as LZF, for tests: the last place of each three bytes is a candidate for a copy.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

namespace delray::tests {

inline std::string pack_lzf(const std::string& bytes) {
  std::string packed, literals;
  const auto flush = [&] {
    if (literals.empty()) return;
    packed += static_cast<char>(literals.size() - 1);
    packed += literals;
    literals.clear();
  };
  std::unordered_map<std::uint32_t, std::size_t> seen;
  for (std::size_t i = 0; i < bytes.size();) {
    const bool three = bytes.size() - i >= 3;
    const auto byte = [&](std::size_t k) {
      return std::uint32_t{static_cast<unsigned char>(bytes[i + k])};
    };
    const std::uint32_t next = three ? byte(0) << 16 | byte(1) << 8 | byte(2) : 0;
    const auto found = three ? seen.find(next) : seen.end();
    std::size_t length = 0;
    const bool near = found != seen.end() && i - found->second <= 8192;
    if (near) {
      while (length < 264 && i + length < bytes.size() &&
             bytes[found->second + length] == bytes[i + length]) {
        ++length;
      }
    }
    const std::size_t distance = near ? i - found->second - 1 : 0;
    if (three) seen[next] = i;
    if (length < 3) {
      literals += bytes[i++];
      if (literals.size() == 32) flush();
      continue;
    }
    flush();
    const std::size_t code = std::min<std::size_t>(length - 2, 7);
    packed += static_cast<char>(code << 5 | distance >> 8);
    if (code == 7) packed += static_cast<char>(length - 2 - 7);
    packed += static_cast<char>(distance & 255);
    i += length;
  }
  flush();
  return packed;
}

}  // namespace delray::tests
