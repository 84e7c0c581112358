#include "files/decimal.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <random>
#include <string>

namespace delray::files {
namespace {

TEST(ShortDecimal, IsWhatFromCharsReads) {
  constexpr std::uint64_t kSeed = 20261124;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  int read = 0;
  for (int i = 0; i < 200000; ++i) {
    std::string text = random() % 2 ? "-" : "";
    for (std::uint64_t k = random() % 12; k-- > 0;) text += static_cast<char>('0' + random() % 10);
    if (random() % 4) text += '.';
    for (std::uint64_t k = random() % 12; k-- > 0;) text += static_cast<char>('0' + random() % 10);
    if (random() % 8 == 0) text += std::string_view(" e/x")[random() % 4];
    double value = 0, expected = 0;
    const char* const end = text.data() + text.size();
    const char* const at = read_short_decimal(text.data(), end, value);
    if (at == nullptr) continue;
    ++read;
    const auto [to, error] = std::from_chars(text.data(), end, expected);
    ASSERT_EQ(error, std::errc()) << text;
    ASSERT_EQ(at, to) << text;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected)) << text;
  }
  EXPECT_GT(read, 100000);
}

TEST(ShortDecimal, LeavesOthersToFromChars) {
  for (const std::string text : {"", "-", ".", "-.", "1e5", "1.5E-3", "nan", "inf", "+1",
                                 "12345678901234567890", "0.12345678901234567"}) {
    double value = 0;
    EXPECT_EQ(read_short_decimal(text.data(), text.data() + text.size(), value), nullptr) << text;
  }
}

}  // namespace
}  // namespace delray::files
