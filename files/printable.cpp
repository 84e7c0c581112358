// Text is taken apart by the table of well-formed UTF-8 (Unicode 15, table 3-7).
#include "files/printable.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

namespace delray::files {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  // 0: the first byte begins no character
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead < 0xC2   ? 0
                            : lead < 0xE0 ? 2
                            : lead < 0xF0 ? 3
                            : lead < 0xF5 ? 4
                                          : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kLeast[bytes] || code > 0x10FFFF || surrogate ? Character{}
                                                              : Character{code, bytes};
}

// Controls of terminals, line separators, and directions of writing (Boucher and Anderson 2021).
bool is_obeyed(std::uint32_t code) {
  const auto between = [code](std::uint32_t low, std::uint32_t high) {
    return low <= code && code <= high;
  };
  return (code < 0x20 && code != '\t') || between(0x7F, 0x9F) || code == 0x61C ||
         between(0x200E, 0x200F) || between(0x2028, 0x202E) || between(0x2066, 0x2069) ||
         code == 0xFEFF;
}

std::string escape(const char* format, std::uint32_t code) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), format, code);
  return text.data();
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character c = first_character(text);
    if (c.bytes == 0) {
      result += escape("\\x%02x", static_cast<std::uint8_t>(text[0]));
    } else if (c.code == '\n') {
      result += "\\n";
    } else if (is_obeyed(c.code)) {
      result += escape(c.code < 0x80 ? "\\x%02x" : "\\u%04x", c.code);
    } else {
      result += text.substr(0, c.bytes);
    }
    text.remove_prefix(std::max<std::size_t>(c.bytes, 1));
  }
  return result;
}

}  // namespace delray::files
