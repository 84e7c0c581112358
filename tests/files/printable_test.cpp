// Text is escaped where a terminal would obey it.
#include "files/printable.h"

#include <gtest/gtest.h>

namespace delray::files {
namespace {

TEST(Printable, KeepsTextOfAnyLanguage) {
  for (const char* text : {"", "plain text.obj: line 3", "a\tb", "Größe", "日本語", "😀", "naïve"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesWhatTerminalsObey) {
  EXPECT_EQ(printable("\x1b[31mRED\x1b]0;owned\x07"), "\\x1b[31mRED\\x1b]0;owned\\x07");
  EXPECT_EQ(printable("two\nlines\r"), "two\\nlines\\x0d");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b[31m"), "\\u009b[31m");  // CSI in one character
  EXPECT_EQ(printable("gpj.\xe2\x80\xae.exe"), "gpj.\\u202e.exe");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Printable, EscapesBytesThatAreNotText) {
  EXPECT_EQ(printable("a\xff"), "a\\xff");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\x80z"), "\\x80z");
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");                    // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
}

}  // namespace
}  // namespace delray::files
