// Entries of tables are found by name, the first of several.
#include "files/find_named.h"

#include <gtest/gtest.h>

#include <array>

namespace delray::files {
namespace {

struct Entry {
  const char* name;
  int value;
};
constexpr std::array kTable = {Entry{"one", 1}, Entry{"two", 2}, Entry{"one", 3}};

TEST(FindNamed, FindsTheFirstEntryOfAName) {
  const std::span<const Entry> table = kTable;
  ASSERT_NE(find_named(table, "one"), nullptr);
  EXPECT_EQ(find_named(table, "one"), &kTable[0]);
  EXPECT_EQ(find_named(table, "two"), &kTable[1]);
}

TEST(FindNamed, FindsNothingElse) {
  const std::span<const Entry> table = kTable;
  EXPECT_EQ(find_named(table, "three"), nullptr);
  EXPECT_EQ(find_named(table, "on"), nullptr);
  EXPECT_EQ(find_named(table, ""), nullptr);
  EXPECT_EQ(find_named(std::span<const Entry>(), "one"), nullptr);
}

}  // namespace
}  // namespace delray::files
