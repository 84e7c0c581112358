// What reports say of what takes least.
#include "apps/compare/verdict.h"

#include <gtest/gtest.h>

namespace delray::apps {
namespace {

TEST(Verdict, NamesTheWinnerOrSaysThatThereIsNone) {
  const std::vector<std::string> names = {"a", "b", "c", "d", "e"};
  const std::span<const std::string> all(names);
  EXPECT_EQ(winners_cell({}), "-");
  EXPECT_EQ(winners_cell(all.first(1)), "a");
  EXPECT_EQ(winners_cell(all.first(2)), "a \u2248 b");
  EXPECT_EQ(winners_cell(all.first(3)), "a \u2248 2 more");
  EXPECT_EQ(listed(all.first(1)), "a");
  EXPECT_EQ(listed(all.first(2)), "a and b");
  EXPECT_EQ(listed(all.first(3)), "a, b and c");
  EXPECT_EQ(listed(all), "a, b, c, d and e");
  EXPECT_EQ(listed(all, 3), "a, b, c and 2 more");
}

TEST(Verdict, TellsTimesWithTheirSpread) {
  EXPECT_EQ(measured_text(spread_of({2e-3, 1e-3, 4e-3})),
            "2 ms (measured, median of 3 runs, 1 ms to 4 ms)");
  EXPECT_EQ(measured_text(spread_of({2.5})), "2.5 s (measured once)");
  EXPECT_EQ(milliseconds_cell(spread_of({2e-3, 1e-3, 4e-3})), "2 (1 to 4)");
  EXPECT_EQ(milliseconds_cell(spread_of({2e-3})), "2 (once)");
}

TEST(Verdict, PicksRowsThatCannotBeToldFromTheLeast) {
  struct Row {
    char name;
    Spread seconds;
  };
  const Row slow{'s', spread_of({7, 8, 9})}, fast{'f', spread_of({1, 2, 3})},
      as_fast{'a', spread_of({2, 3, 4})};
  const std::vector<const Row*> rows = {&slow, &as_fast, &fast};
  const auto best = winners<Row>(rows, [](const Row& row) { return row.seconds; });
  EXPECT_EQ(best, (std::vector<const Row*>{&fast, &as_fast}));
}

}  // namespace
}  // namespace delray::apps
