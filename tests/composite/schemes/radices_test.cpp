#include "composite/schemes/radices.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace delray::composite::internal {
namespace {

TEST(Radices, MakeUpAnyNumberOfRanks) {
  const std::vector<std::vector<int>> wishes = {{}, {2}, {8, 4}, {1}, {3, 5, 2}, {100}};
  for (const std::vector<int>& wished : wishes) {
    for (int ranks = 1; ranks <= 300; ++ranks) {
      SCOPED_TRACE(std::to_string(ranks) + " ranks");
      const Radices plan = choose_radices(ranks, wished);
      EXPECT_EQ(std::accumulate(plan.radices.begin(), plan.radices.end(), 1, std::multiplies<>()),
                plan.members);
      ASSERT_GE(plan.extra(), 0);
      ASSERT_LT(plan.extra(), std::max(1, plan.members));
      for (std::size_t round = 0; round < plan.radices.size(); ++round) {
        const int most =
            wished.empty() ? 8 : std::max(2, wished[std::min(round, wished.size() - 1)]);
        EXPECT_LE(plan.radices[round], most);
        EXPECT_GE(plan.radices[round], 2);
      }
      int member = 0, extra = 0, block = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const RadixPlace place = place_of(plan, rank);
        ASSERT_GE(place.block, block);
        block = place.block;
        ASSERT_EQ(place.first_rank, plan.first_of(block));
        if (place.member < 0) {
          ++extra;
          ASSERT_GE(rank, place.first_rank + plan.block());
          ASSERT_LT(rank, place.first_rank + plan.block() + place.extra);
        } else {
          ASSERT_EQ(place.member, member++);
          ASSERT_EQ(rank_of(plan, place.member), rank);
        }
      }
      EXPECT_EQ(member, plan.members);
      EXPECT_EQ(extra, plan.extra());
      EXPECT_EQ(block, plan.blocks() - 1);
    }
  }
}

TEST(Radices, AreThoseWished) {
  EXPECT_EQ(choose_radices(32, std::vector{8, 4}).radices, (std::vector{8, 4}));
  EXPECT_EQ(choose_radices(12, std::vector{2, 3}).radices, (std::vector{2, 3, 2}));
  EXPECT_EQ(choose_radices(7, std::vector{8}).radices, (std::vector{7}));
}

TEST(Radices, LeaveFewRanksOver) {
  for (const int prime : {31, 61, 127, 251, 509, 1021, 2039, 4093, 65521}) {
    const Radices plan = choose_radices(prime, {});
    EXPECT_LE(plan.extra(), prime / 16) << prime;
    EXPECT_LE(plan.extra(), plan.blocks()) << prime;
  }
}

}  // namespace
}  // namespace delray::composite::internal
