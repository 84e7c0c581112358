#include "files/line_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "tests/support/temporary_folder.h"

namespace delray::files {
namespace {

std::string random_text(std::mt19937& random) {
  std::string text;
  for (unsigned lines = random() % 12; lines-- > 0;) {
    text.append(random() % 5 == 0 ? random() % 200 : random() % 6, 'x');
    text += random() % 4 == 0 ? "\\\n" : random() % 3 == 0 ? "\r\n" : "\n";
  }
  if (random() % 2) text += "end";
  return text;
}

// Ranges follow each other, are cut behind line ends only, and count lines as the text has them.
void expect_cut_well(const FileBytes& bytes, const std::string& text, std::uint64_t begin,
                     std::uint64_t range_bytes, char continued) {
  const LineRanges ranges(bytes, begin, range_bytes, continued);
  std::string all, buffer;
  std::uint64_t lines = 0;
  for (std::size_t i = 0; i < ranges.ranges(); ++i) {
    ASSERT_EQ(ranges.begin(i), begin + all.size());
    all += ranges.read(i, buffer);
    lines += ranges.lines(i);
    if (i + 1 == ranges.ranges() || all.empty() || begin + all.size() == text.size()) continue;
    ASSERT_EQ(all.back(), '\n');
    ASSERT_FALSE(continued != '\0' && all.ends_with("\\\n"));
  }
  EXPECT_EQ(all, text.substr(begin));
  const auto ends = static_cast<std::uint64_t>(std::count(all.begin(), all.end(), '\n'));
  EXPECT_EQ(lines, ends + (!all.empty() && all.back() != '\n' ? 1 : 0));
}

TEST(LineRanges, AreTheTextCutBehindLineEnds) {
  constexpr unsigned kSeed = 23;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const tests::TemporaryFolder folder;
  for (int i = 0; i < 300; ++i) {
    const std::string text = random_text(random);
    const std::size_t first = text.find('\n');
    const std::uint64_t begin = random() % 3 == 0 && first != text.npos ? first + 1 : 0;
    for (const std::uint64_t range_bytes : {1, 2, 7, 64, 5000}) {
      for (const char continued : {'\0', '\\'}) {
        SCOPED_TRACE(testing::Message() << text << "; " << range_bytes);
        expect_cut_well(FileBytes("text", std::string_view(text), {}), text, begin, range_bytes,
                        continued);
        if (i % 30 == 0) {
          expect_cut_well(FileBytes(folder.write("text", text), {}), text, begin, range_bytes,
                          continued);
        }
      }
    }
  }
}

}  // namespace
}  // namespace delray::files
