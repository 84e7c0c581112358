// Counts: what is before the exponent is kept as digits, to which the exponent adds zeros, so that
// nothing is rounded.
#include "files/parse_count.h"

#include <charconv>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

namespace delray::files {
namespace {

constexpr int kMostExponent = 1000;  // more is too large or a fraction, whatever the digits
constexpr int kMostDigits = 20;      // of 2^64 - 1

// digits * 10^exponent
struct Decimal {
  std::string digits;
  int exponent = 0;
};

[[noreturn]] void fail(std::string_view text, const char* why) {
  throw std::invalid_argument("'" + std::string(text) + "' is " + why);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Cuts digits and a point off `rest`.
Decimal take_digits(std::string_view& rest) {
  Decimal number;
  bool after_point = false;
  std::size_t i = 0;
  for (; i < rest.size(); ++i) {
    if (is_digit(rest[i])) {
      number.digits += rest[i];
      if (after_point) --number.exponent;
    } else if (rest[i] == '.' && !after_point) {
      after_point = true;
    } else {
      const bool separates = rest[i] == '_' && i > 0 && i + 1 < rest.size() &&
                             is_digit(rest[i - 1]) && is_digit(rest[i + 1]);
      if (!separates) break;
    }
  }
  rest.remove_prefix(i);
  return number;
}

// The power of ten that "e6", "k" or nothing stands for; none for anything else.
std::optional<int> exponent_of(std::string_view text) {
  if (text.empty()) return 0;
  if (text == "k" || text == "K") return 3;
  if (text == "m" || text == "M") return 6;
  if (text == "g" || text == "G") return 9;
  if (text[0] != 'e' && text[0] != 'E') return std::nullopt;
  text.remove_prefix(text.substr(1).starts_with('+') ? 2 : 1);
  int exponent = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, exponent);
  const bool fine = error == std::errc() && rest == end && exponent >= -kMostExponent &&
                    exponent <= kMostExponent;
  return fine ? std::optional(exponent) : std::nullopt;
}

}  // namespace

std::uint64_t parse_count(std::string_view text) {
  constexpr const char* kNoCount = "not a whole number such as 1000000, 1e6 or 10k";
  std::string_view rest = text;
  Decimal number = take_digits(rest);
  const std::optional<int> exponent = exponent_of(rest);
  if (number.digits.empty() || !exponent) fail(text, kNoCount);
  number.exponent += *exponent;
  for (; number.digits.ends_with('0'); ++number.exponent) number.digits.pop_back();
  if (number.digits.empty()) return 0;
  if (number.exponent < 0) fail(text, kNoCount);
  std::uint64_t count = 0;
  if (number.exponent < kMostDigits) {
    number.digits.append(static_cast<std::size_t>(number.exponent), '0');
    const char* const end = number.digits.data() + number.digits.size();
    if (std::from_chars(number.digits.data(), end, count).ec == std::errc()) return count;
  }
  fail(text, "too large");
}

}  // namespace delray::files
