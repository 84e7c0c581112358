// Wherever a text is cut into ranges, its points and complaints are those of the whole.
#include "delaunay/files/parts/text_parts.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/fuzz/text_in_parts.h"

namespace delray::tests {
namespace {

TEST(TextParts, GiveWhatTheWholeTextGives) {
  constexpr unsigned kSeed = 20046;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  const char* const words[] = {"1",  "-2.5", "3e2", "x", "",       "nan", "7 8",   "1,2", "5;6",
                               "#c", "255",  "0",   " ", "1e-400", "y",   "class", "+4",  "//"};
  int cut = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text = random() % 8 == 0 ? "x y z intensity\n" : random() % 8 == 0 ? "9 3\n" : "";
    const char* const end = random() % 4 == 0 ? "\r\n" : "\n";
    // Mostly good rows, so that more than the first ones are read.
    const bool wild = random() % 4 == 0;
    for (unsigned rows = random() % 12; rows > 0; --rows) {
      for (int k = 0; k < 3; ++k) text += std::to_string(random() % 1000) + (k < 2 ? " " : "");
      if (wild && random() % 3 == 0) text += std::string(" ") + words[random() % 18];
      text += random() % 5 == 0 ? std::string(end) + end : end;
      if (random() % 9 == 0) text += "# " + std::string(random() % 90, 'c') + end;
    }
    if (random() % 3 == 0 && !text.empty()) text.pop_back();
    const PartsComparison result = compare_with_parts(text, 1 + random() % 60);
    ASSERT_TRUE(result.same) << text;
    cut += result.cut ? 1 : 0;
  }
  EXPECT_GT(cut, 2000);
}

}  // namespace
}  // namespace delray::tests
