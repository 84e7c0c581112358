// Counts are read exactly or refused.
#include "files/parse_count.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace delray::files {
namespace {

std::string refusal(std::string_view text) {
  try {
    return "taken for " + std::to_string(parse_count(text));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(ParseCount, ReadsCountsAsTheyAreWritten) {
  EXPECT_EQ(parse_count("0"), 0U);
  EXPECT_EQ(parse_count("000"), 0U);
  EXPECT_EQ(parse_count("0e1000"), 0U);
  EXPECT_EQ(parse_count("1000"), 1000U);
  EXPECT_EQ(parse_count("007"), 7U);
  EXPECT_EQ(parse_count("1e6"), 1'000'000U);
  EXPECT_EQ(parse_count("1E+6"), 1'000'000U);
  EXPECT_EQ(parse_count("2.5e5"), 250'000U);
  EXPECT_EQ(parse_count(".5e1"), 5U);
  EXPECT_EQ(parse_count("2.50e1"), 25U);
  EXPECT_EQ(parse_count("3.0"), 3U);
  EXPECT_EQ(parse_count("500e-2"), 5U);
  EXPECT_EQ(parse_count("10k"), 10'000U);
  EXPECT_EQ(parse_count("1.5K"), 1'500U);
  EXPECT_EQ(parse_count("5M"), 5'000'000U);
  EXPECT_EQ(parse_count("1G"), 1'000'000'000U);
  EXPECT_EQ(parse_count("1_000_000"), 1'000'000U);
}

TEST(ParseCount, IsExact) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(parse_count("18446744073709551615"), most);
  EXPECT_EQ(parse_count("1.8446744073709551615e19"), most);
  EXPECT_EQ(parse_count("9007199254740993"), 9007199254740993U) << "no double";
  EXPECT_EQ(parse_count("1e19"), 10'000'000'000'000'000'000U);
}

TEST(ParseCount, RefusesFractions) {
  for (const char* text : {"2.5", "1e-1", "1.2345k", "0.5", "1e-1000"}) {
    EXPECT_EQ(refusal(text),
              "'" + std::string(text) + "' is not a whole number such as 1000000, 1e6 or 10k");
  }
}

TEST(ParseCount, RefusesWhatIsTooLarge) {
  for (const char* text :
       {"18446744073709551616", "1e20", "1e999", "20000000000G", "99999999999e10"})
    EXPECT_EQ(refusal(text), "'" + std::string(text) + "' is too large");
}

TEST(ParseCount, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"",      "-1",  "+1",    "e6",    "1e",   "1e+", "1e6k", "1kk",  "k",    ".",
        "1.2.3", " 1",  "1 ",    "1,000", "0x10", "_1",  "1_",   "1__0", "1_.5", "1e99999999999",
        "nan",   "inf", "1e+-6", "1T"}) {
    EXPECT_THROW(parse_count(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace delray::files
