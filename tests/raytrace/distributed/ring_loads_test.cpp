#include "raytrace/distributed/ring_loads.h"

#include <gtest/gtest.h>

namespace delray::raytrace {
namespace {

constexpr std::uint64_t kStep = RingLoads::kTestsBetween;

TEST(RingLoads, AreToldNowAndThen) {
  RingLoads loads;
  EXPECT_FALSE(loads.tell(kStep - 1));
  EXPECT_TRUE(loads.tell(kStep + 5));
  EXPECT_FALSE(loads.tell(2 * kStep + 4));
  EXPECT_TRUE(loads.tell(2 * kStep + 5));
}

TEST(RingLoads, GiveToAMuchLessLoadedNeighbourOnly) {
  RingLoads loads;
  EXPECT_FALSE(loads.should_give(kStep));
  EXPECT_TRUE(loads.should_give(2 * kStep));  // it would have told if it had done a step
  loads.hear(9 * kStep);
  EXPECT_FALSE(loads.should_give(10 * kStep));
  EXPECT_TRUE(loads.should_give(11 * kStep));
  loads.gave(11 * kStep);
  EXPECT_FALSE(loads.should_give(12 * kStep - 1));
  EXPECT_TRUE(loads.should_give(12 * kStep));
  loads.hear(12 * kStep);
  EXPECT_FALSE(loads.should_give(13 * kStep));
}

}  // namespace
}  // namespace delray::raytrace
