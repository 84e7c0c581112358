// Decimal numbers of few digits, as texts of coordinates have them.
#pragma once

#include <array>
#include <cstdint>

namespace delray::files {

// The double nearest to the number that begins at `begin`, with a sign and a point perhaps and
// without an exponent; returns where the number ends, null where it is none of these, or longer
// than 19 digits with more than 15 that count: std::from_chars then takes over. Digits make a whole
// number below 2^53 and the point a power of ten of at most 22, both exact, so that their quotient
// is rounded once (Clinger 1990, "How to read floating point numbers accurately").
inline const char* read_short_decimal(const char* begin, const char* end, double& value) {
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  constexpr int kMostDigits = 19;
  constexpr std::array kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
                                  1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
  const char* at = begin;
  const bool negative = at != end && *at == '-';
  if (negative) ++at;
  std::uint64_t digits = 0;
  const char* const first = at;
  const auto digit = [&] { return static_cast<unsigned>(*at - '0'); };
  for (; at != end && digit() < 10; ++at) digits = digits * 10 + digit();
  std::int64_t count = at - first, decimals = 0;
  if (at != end && *at == '.') {
    const char* const point = ++at;
    for (; at != end && digit() < 10; ++at) digits = digits * 10 + digit();
    decimals = at - point;
    count += decimals;
  }
  if (count == 0 || count > kMostDigits || digits > kExact) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) return nullptr;
  const double whole = static_cast<double>(digits);
  const double magnitude =
      decimals == 0 ? whole : whole / kPowers[static_cast<std::size_t>(decimals)];
  value = negative ? -magnitude : magnitude;
  return at;
}

}  // namespace delray::files
