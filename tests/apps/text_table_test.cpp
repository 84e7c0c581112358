#include "apps/terminal/text_table.h"

#include <gtest/gtest.h>

#include <sstream>

#include "apps/terminal/terminal.h"

namespace delray::apps {
namespace {

const TextTable kTable = {{"ranks", "scheme", "codec", "messages", "compose ms"},
                          {"2", "tree", "dense", "2", "10.25"},
                          {"2", "radix-k", "dense", "14", "-"},
                          {"16", "tree", "dense", "30", "9.5"}};

TEST(TextTable, AlignsNumbersToTheRightAndTextToTheLeft) {
  EXPECT_EQ(aligned(kTable, kUnlimited),
            "ranks  scheme   codec  messages  compose ms\n"
            "    2  tree     dense         2       10.25\n"
            "    2  radix-k  dense        14           -\n"
            "   16  tree     dense        30         9.5\n");
  EXPECT_EQ(aligned(kTable, 43), aligned(kTable, kUnlimited)) << "fits exactly";
}

// Ranks and scheme tell the lines apart.
TEST(TextTable, RepeatsWhatTellsLinesApartWhereItIsNarrow) {
  EXPECT_EQ(aligned(kTable, 42),
            "ranks  scheme   codec  messages\n"
            "    2  tree     dense         2\n"
            "    2  radix-k  dense        14\n"
            "   16  tree     dense        30\n"
            "\n"
            "ranks  scheme   compose ms\n"
            "    2  tree          10.25\n"
            "    2  radix-k           -\n"
            "   16  tree            9.5\n");
}

TEST(TextTable, KeepsAllColumnsHoweverNarrow) {
  const std::string text = aligned(kTable, 1);
  for (const std::string& heading : kTable[0]) EXPECT_NE(text.find(heading), std::string::npos);
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) count += !line.empty();
  EXPECT_EQ(count, 3 * 4) << "a table for each column besides ranks and scheme";
}

TEST(TextTable, EqualLinesAreKept) {
  const TextTable table = {{"a", "b"}, {"x", "y"}, {"x", "y"}};
  EXPECT_EQ(aligned(table, kUnlimited), "a  b\nx  y\nx  y\n");
  EXPECT_EQ(aligned({{"a", "b"}}, kUnlimited), "a  b\n") << "a heading alone";
}

TEST(Wrapped, CutsAtBlanks) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(wrapped("one two three", 7), (Lines{"one two", "three"}));
  EXPECT_EQ(wrapped("one two three", 13), (Lines{"one two three"}));
  EXPECT_EQ(wrapped("one two three", 12), (Lines{"one two", "three"}));
  EXPECT_EQ(wrapped("a longerthanthat b", 5), (Lines{"a", "longerthanthat", "b"}));
  EXPECT_EQ(wrapped("", 5), (Lines{""}));
  EXPECT_EQ(wrapped("one two", kUnlimited), (Lines{"one two"}));
}

}  // namespace
}  // namespace delray::apps
