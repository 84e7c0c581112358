// From whom idle ranks take how much.
#include "loadbalance/schedules/steal_by_loads.h"

#include <gtest/gtest.h>

#include <numeric>

namespace delray::loadbalance::internal {
namespace {

using Requests = std::vector<StealRequest>;

TEST(StealByLoads, HalfOfTheRestIsTakenFromTheMostLoaded) {
  const std::vector<std::uint64_t> loads = {0, 3, 9, 9, 1};
  EXPECT_EQ(kStealHalf.requests(loads), (Requests{{2, 5}}));
  EXPECT_EQ(kStealHalf.requests(std::vector<std::uint64_t>{0, 0, 0}), Requests());
  EXPECT_EQ(kStealHalf.requests(std::vector<std::uint64_t>{0}), Requests());
}

// Each gets half of what those before it have left: none is ever left with everything taken.
TEST(StealByLoads, RanksThatFinishTogetherDoNotTakeAllOfIt) {
  std::uint64_t left = 1024;
  for (const std::uint64_t expected : {512U, 256U, 128U, 64U}) {
    const std::uint64_t taken = kStealHalf.released(left, 512);
    EXPECT_EQ(taken, expected);
    left -= taken;
  }
  EXPECT_EQ(left, 64U);
  EXPECT_EQ(kStealHalf.released(1, 1), 1U);
  EXPECT_EQ(kStealHalf.released(0, 1), 0U);
}

// In proportion to what they have above the mean, the mean together.
TEST(StealByLoads, StealingTakesTheMeanFromAllAboveIt) {
  const std::vector<std::uint64_t> loads = {0, 10, 30, 0};
  const Requests requests = kStealFromAboveMean.requests(loads);
  EXPECT_EQ(requests, (Requests{{2, 10}}));
  const Requests two = kStealFromAboveMean.requests(std::vector<std::uint64_t>{0, 20, 20, 0});
  EXPECT_EQ(two, (Requests{{1, 5}, {2, 5}}));
}

}  // namespace
}  // namespace delray::loadbalance::internal
